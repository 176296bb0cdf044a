#ifndef HANDHOLD_MATCH_H
#define HANDHOLD_MATCH_H

#include <handhold/players.h>
#include <handhold/world.h>

/* Matches: one world on several machines. Inputs travel, states do not. A server orders the inputs;
 * each player's machine is a client, which steps its own input at once, guesses those of others,
 * and goes back and steps again where a guess was wrong. The transport is yours: hand packets in,
 * take packets out. There are no sockets, no threads and no clock in here.
 *
 * All machines make equal worlds first: the same level, players, names, tuning and shapes. None of
 * that is in a packet. Nothing but the match may change the world then, apart from hh_match_game's
 * step: hh_world_step and its kin, hh_world_begin_step, hh_world_restore and hh_world_destroy
 * return or log HH_ERROR_STATE while the world is in a match.
 *
 * A tick is one step of the world, hh_world_time's `frame`. A tick is confirmed once its inputs are
 * final; the state of a confirmed tick is equal on all machines, bit for bit. */

#ifdef __cplusplus
extern "C" {
#endif

/* A world's part in a match. */
typedef struct hh_match hh_match;

#define HH_MATCH_PLAYERS 16        /* most players of a match */
#define HH_MATCH_PACKET_BYTES 1200 /* most bytes of a packet */
#define HH_MATCH_INPUTS_BYTES 8192 /* most bytes of hh_match_confirmed_inputs */
#define HH_MATCH_NO_SLOT 0xffffffffu
#define HH_MATCH_PLACES 64   /* copies of its own state that a game keeps */
#define HH_MATCH_REFUSALS 16 /* length of hh_match_stats.refused */

typedef enum hh_match_role {
    HH_MATCH_CLIENT = 0,
    HH_MATCH_SERVER = 1,
    /* No network: every tick is stepped again from `sync_ticks` before, and must give the same
     * hashes. Finds state that your game forgets to restore. */
    HH_MATCH_SYNC_TEST = 2,
    /* Nobody's machine: steps confirmed ticks only, from hh_match_confirmed_inputs. For those who
     * watch, and for recordings of matches. Has no slot and sends no packets. */
    HH_MATCH_SPECTATOR = 3,
    HH_MATCH_ROLE_32_BITS = 0x7fffffff
} hh_match_role;

typedef struct hh_match_def {
    uint32_t struct_size;
    hh_match_role role;       /* default HH_MATCH_CLIENT */
    const hh_player* players; /* by slot, the same on every machine; copied. All are in the world,
                                 also while nobody plays them */
    size_t player_count;      /* [1, HH_MATCH_PLAYERS] */
    double tick_s;            /* length of a tick, [1e-3, 0.1]; default 1/90 */
    uint32_t slot;            /* client: this machine's player; default 0 */
    uint32_t sync_ticks;      /* sync test: ticks stepped again each time, [1, 62]; default 8 */
    double start_s;           /* server: time on its clock at the world's present tick; default 0 */
} hh_match_def;
HH_API hh_result hh_default_match_def_sized(hh_match_def* filled, size_t size);
static inline hh_match_def hh_default_match_def(void) {
    hh_match_def filled;
    hh_default_match_def_sized(&filled, sizeof(filled));
    return filled;
}

/* Your own state of the match, such as scores and doors' codes, which goes back and forth with the
 * world's. Null functions are not called; `save` and `restore` come together. Inside of them no
 * function of the match may be called, and none that steps, restores or destroys the world. */
typedef struct hh_match_game {
    uint32_t struct_size;
    void* context; /* passed to each of the functions */
    /* Called after each step of the world to `tick`, also when it is stepped again. May read the
     * world and its events, and may change its bodies, joints, grips and players; it must not add
     * or remove any. What it does may depend on the world, your state, `tick` and `buttons` only:
     * hh_match_input.buttons of each slot, of which there are `button_count`. What hosts draw, such
     * as hh_player_pose, differs between machines. */
    void (*step)(void* context, uint64_t tick, const uint32_t* buttons, size_t button_count);
    /* Keeps a copy of your state in a place of yours, [0, HH_MATCH_PLACES), over the one before. A
     * server saves nothing. */
    void (*save)(void* context, uint32_t place);
    /* Sets your state to the copy in that place. */
    void (*restore)(void* context, uint32_t place);
    /* Hash of your state: machines compare it together with the world's. */
    uint64_t (*hash)(void* context);
} hh_match_game;
HH_API hh_result hh_default_match_game_sized(hh_match_game* filled, size_t size);
static inline hh_match_game hh_default_match_game(void) {
    hh_match_game filled;
    hh_default_match_game_sized(&filled, sizeof(filled));
    return filled;
}

/* Begins a match at the world's present tick. `game` null: no state of your own. HH_ERROR_STATE if
 * the world is in a match already, or a step has begun; HH_ERROR_HANDLE for unknown players. A
 * client that joins late calls hh_match_join before anything else. Memory: 64 copies
 * of what moves, and up to 3 MB of inputs. */
HH_API hh_result hh_match_create(hh_world* world, const hh_match_def* def,
                                 const hh_match_game* game, hh_match** match);
/* Ends it. The world stays as it is, and may be stepped or destroyed again. Null, or inside a
 * function of its game or a surface query: nothing happens. */
HH_API void hh_match_destroy(hh_match* match);

/* ---- Clients and spectators ---- */

/* A player's input for one tick. Fill by hh_default_match_input. */
typedef struct hh_match_input {
    uint32_t struct_size;
    uint32_t buttons; /* your bits, for hh_match_game.step */
    /* As in hh_player_input, on the world's clock: a sample at the tick's end has hh_world_time
     * plus tick_s. Later ones are kept for later ticks, at most 64. Poses become integers of 0.1 mm
     * and 1 mrad, the same on every machine. Without a sample for 0.1 s devices count as not
     * tracked. */
    const hh_tracking_sample* samples;
    size_t sample_count;
    /* True: the tick is not shown, as by hh_world_step_simulated. For all but the last of several
     * ticks in one frame. Default false. */
    uint8_t is_hidden;
    hh_commands commands;
} hh_match_input;
HH_API hh_result hh_default_match_input_sized(hh_match_input* filled, size_t size);
static inline hh_match_input hh_default_match_input(void) {
    hh_match_input filled;
    hh_default_match_input_sized(&filled, sizeof(filled));
    return filled;
}

/* How often to call hh_match_advance for so much time of the local clock since the last call, [0,
 * 8]: a little more or less than its share, so that inputs reach the server just before they are
 * needed. A spectator stays 9 ticks behind what has come. */
HH_API hh_result hh_match_ticks_due(hh_match* match, double elapsed_s, uint32_t* ticks);
/* Goes back to the first wrong guess, if there is one, steps again to the present, and then one
 * tick on. `input`, not null. `advanced` gets false, and the input is dropped, while the world is
 * 62 ticks ahead of the last confirmed tick. Each tick stepped again costs about a quarter of a
 * shown step: docs/reference/matches.md has figures. A spectator steps the next confirmed tick, or gets
 * false if its inputs have not come; of `input` it takes only is_hidden. */
HH_API hh_result hh_match_advance(hh_match* match, const hh_match_input* input, uint8_t* advanced);
/* Takes a packet of the server; a spectator those of hh_match_confirmed_inputs. HH_ERROR_DATA, and
 * no change, for bytes that are damaged or not of this match. Packets that came too late or out of
 * order are HH_OK: what they lack comes again. Both are counted in hh_match_stats.refused.
 * Tolerates any bytes. */
HH_API hh_result hh_match_receive(hh_match* match, const void* packet, size_t size);
/* Clients only. Writes the next packet to the server, `size` bytes. Call once a tick or once in
 * two. A null `buffer` asks for the most bytes that a packet has, HH_MATCH_PACKET_BYTES;
 * HH_ERROR_CAPACITY for a smaller `capacity`. */
HH_API hh_result hh_match_packet(hh_match* match, void* buffer, size_t capacity, size_t* size);
/* Replaces the world's state by the one of hh_match_state, over a reliable stream of yours. Set
 * your own state to the server's of the same tick before the next hh_match_advance. HH_ERROR_DATA,
 * and no change, for other bytes. Tolerates any bytes. */
HH_API hh_result hh_match_join(hh_match* match, const void* bytes, size_t size);

/* ---- Servers ---- */

/* Somebody plays the slot, or nobody does: then its hands let go and its body floats. At first
 * nobody plays any slot. */
HH_API hh_result hh_match_connect(hh_match* match, uint32_t slot);
HH_API hh_result hh_match_disconnect(hh_match* match, uint32_t slot);
/* Takes a packet that came from that slot's player, at `now_s` on the server's clock. As
 * hh_match_receive; a packet of another slot is HH_ERROR_DATA. The checksum in it finds damage, not
 * forgery: your transport authenticates. */
HH_API hh_result hh_match_receive_from(hh_match* match, uint32_t slot, double now_s,
                                       const void* packet, size_t size);
/* Confirms and steps the ticks whose inputs are complete, or which have ended on the server's
 * clock; missing inputs are filled by a guess that all machines share. At most 16 a call; `ticks`
 * gets the number. Call several times a tick. Null output: skipped. */
HH_API hh_result hh_match_confirm(hh_match* match, double now_s, uint32_t* ticks);
/* Writes the next packet to that slot's player. As hh_match_packet. */
HH_API hh_result hh_match_packet_to(hh_match* match, uint32_t slot, void* buffer, size_t capacity,
                                    size_t* size);
/* Writes the state that a player joins with, `size` bytes, for hh_match_join; send your own state
 * of this tick with it. From now on the player is sent the inputs after it. As hh_world_save; with
 * a null `buffer` nothing changes. HH_MATCH_NO_SLOT: the state for a spectator, who is sent the
 * confirmed inputs after the present tick. */
HH_API hh_result hh_match_state(hh_match* match, uint32_t slot, void* buffer, size_t capacity,
                                size_t* size);

/* ---- Sync test ---- */

/* The first tick whose hash changed when it was stepped again. */
typedef struct hh_match_difference {
    uint64_t tick;    /* 0: none */
    uint8_t in_world; /* hh_world_simulated_hash differs */
    uint8_t in_game;  /* hh_match_game.hash differs */
} hh_match_difference;
/* Steps one tick with an input for each slot, then goes back sync_ticks and steps again. */
HH_API hh_result hh_match_sync_test(hh_match* match, const hh_match_input* inputs,
                                    size_t input_count, hh_match_difference* difference);

/* ---- Servers, clients and spectators ---- */

/* Writes the inputs of all slots in the confirmed ticks after `after`, for hh_match_receive of
 * spectators: over a reliable stream of yours, or into a file, which then has the whole match.
 * `until` gets the last tick written, `after` if there is nothing new: 128 ticks at most, and fewer
 * if the buffer is full. Every 90th tick carries its hash, which the reader compares.
 * HH_ERROR_VALUE if `after` is later than the last confirmed tick, or too early: 320 ticks are always
 * kept, at most 448. A spectator then needs a state. A null `buffer` asks for
 * HH_MATCH_INPUTS_BYTES; HH_ERROR_CAPACITY for less. */
HH_API hh_result hh_match_confirmed_inputs(const hh_match* match, uint64_t after, void* buffer,
                                           size_t capacity, size_t* size, uint64_t* until);

/* ---- All ---- */

/* A player needs hh_match_state and hh_match_join: the world differs from the server's, or inputs
 * are lost for good. A client answers for its own slot only, a spectator for any. */
HH_API hh_result hh_match_needs_state(const hh_match* match, uint32_t slot, uint8_t* needs);
/* Hash of world and game after a tick: equal on all machines if the tick is confirmed.
 * HH_ERROR_VALUE unless it is the present one or, on a client, one of the 63 before that it has
 * stepped. */
HH_API hh_result hh_match_hash(const hh_match* match, uint64_t tick, uint64_t* hash);

/* Add these to the drawn positions of a slot's player, so that a corrected guess moves them within
 * 0.08 s and not at once: to head and body, and to each hand with what it holds. m, world axes. For
 * the own slot `head` is for the view too, with hands that hold nothing: it moves when others pull
 * at what you hold. Only for pictures. Zero for servers, spectators and sync tests. */
HH_API hh_result hh_match_shown_offsets(const hh_match* match, uint32_t slot, hh_vec3* head,
                                        hh_vec3* left, hh_vec3* right);

/* Where to draw a slot's player between two ticks, for displays of another rate than the tick's:
 * at the time up to which hh_match_ticks_due has been called, less one tick, which lies between the
 * last two shown ticks. Call after the ticks of a picture. With hh_match_shown_offsets already.
 * World poses: `origin` is the space of the samples, for the camera rig; `head`; and wrists to
 * draw. A play space that moves by more than 0.5 m or turns by more than 0.2 rad at once, as by a
 * teleport or a snap turn, is not drawn in between. While the world waits, everything stands still.
 * `newest`, for the own slot: the devices at the time of the picture, of any time_s. Head
 * and empty hands are then drawn where they are, and not late. Null: between ticks, as everything
 * else. Fingers go with their wrist; arms, spine and legs with the head. Never changes the world.
 * HH_ERROR_VALUE if `newest` is given for another slot, or to a spectator.
 * Clients and spectators. HH_ERROR_STATE before the first shown tick, and after hh_match_join. */
HH_API hh_result hh_match_drawn_player(const hh_match* match, uint32_t slot,
                                       const hh_tracking_sample* newest, hh_pose* origin,
                                       hh_pose* head, hh_pose* left, hh_pose* right);
/* The same for bodies: poses as of hh_world_body_poses. A body that is held goes with its hands;
 * one that moves by more than 0.5 m at once is not drawn in between. */
HH_API hh_result hh_match_drawn_bodies(const hh_match* match, const hh_body* bodies, size_t count,
                                       hh_pose* poses);

typedef enum hh_match_event_state {
    /* It happened in a tick that may change. Each such event is confirmed or retracted later. */
    HH_MATCH_PREDICTED = 0,
    HH_MATCH_CONFIRMED = 1, /* its tick is final. Each event of a confirmed tick comes so once */
    HH_MATCH_RETRACTED = 2, /* a predicted event that did not happen */
    HH_MATCH_EVENT_STATE_32_BITS = 0x7fffffff
} hh_match_event_state;
/* Grows with hh_event, its last field. */
typedef struct hh_match_event {
    uint64_t tick;
    hh_match_event_state state;
    hh_event event; /* `position` is that of the tracked hand, not of the shown one */
} hh_match_event;
/* What the last hh_match_advance, hh_match_confirm, hh_match_join or hh_match_sync_test found, in
 * the order of finding. Servers and sync tests have confirmed events only. Valid until the next
 * call of these or of this function. `event_size`: bytes of hh_match_event as the host knows it;
 * the list's elements lie so far apart. */
HH_API hh_result hh_match_events_sized(const hh_match* match, const hh_match_event** events,
                                       size_t* count, size_t event_size);
static inline hh_result hh_match_events(const hh_match* match, const hh_match_event** events,
                                        size_t* count) {
    return hh_match_events_sized(match, events, count, sizeof(hh_match_event));
}

/* Why a packet was refused: index of hh_match_stats.refused. */
typedef enum hh_match_refusal {
    HH_MATCH_REFUSED_SIZE = 1,      /* shorter than any packet, or longer */
    HH_MATCH_REFUSED_CHECKSUM = 2,  /* damaged */
    HH_MATCH_REFUSED_VERSION = 3,   /* of another version of the format, or another kind */
    HH_MATCH_REFUSED_SENDER = 4,    /* another slot's, or of one that is not connected */
    HH_MATCH_REFUSED_MALFORMED = 5, /* fields out of range */
    HH_MATCH_REFUSED_GAP = 6,       /* inputs before it have not arrived. Usual with losses */
    HH_MATCH_REFUSED_WINDOW = 7,    /* too old or too far ahead. Usual around joins */
    HH_MATCH_REFUSED_STATE = 8,     /* a state that hh_match_join could not restore */
    HH_MATCH_REFUSAL_32_BITS = 0x7fffffff
} hh_match_refusal;
/* Counts since the match began, where nothing else is said. */
typedef struct hh_match_stats {
    uint32_t struct_size;
    uint64_t tick;        /* the world's present tick */
    uint64_t confirmed;   /* the last tick whose state is final here */
    uint64_t ticks;       /* ticks that the world advanced */
    uint64_t rollbacks;   /* clients, sync tests: times that the world went back */
    uint64_t steps_again; /* ticks stepped again by them */
    uint64_t deepest;     /* most ticks that one of them stepped again */
    uint64_t waits;       /* clients: hh_match_advance that were too far ahead */
    uint64_t filled;      /* inputs that came too late: own ones, or on a server those of all */
    uint64_t hashes;      /* servers, spectators: compared hashes */
    uint64_t out_of_sync; /* servers, spectators: those that differed */
    uint64_t refused[16]; /* packets, by hh_match_refusal; on clients, GAP counts their parts */
} hh_match_stats;
HH_API hh_result hh_default_match_stats_sized(hh_match_stats* filled, size_t size);
static inline hh_match_stats hh_default_match_stats(void) {
    hh_match_stats filled;
    hh_default_match_stats_sized(&filled, sizeof(filled));
    return filled;
}
HH_API hh_result hh_match_get_stats(const hh_match* match, hh_match_stats* stats);

#ifdef __cplusplus
}
#endif

#endif
