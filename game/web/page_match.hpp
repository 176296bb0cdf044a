#pragma once

#include <cstddef>
#include <cstdint>

#include <handhold/match.h>

// The web page's part of a match: the game's levels, rules and MatchPeer in its WebAssembly module.
// JavaScript (game/web/demo/match.js) carries the messages. One match at a time; texts are one line
// and valid until the next call of these functions.
namespace handhold {
extern "C" {

// A mesh that is drawn at a body's pose. Positions and normals are in the body's frame.
struct PageVisual {
    hh_body body;
    const float* vertices;         // position, normal: six numbers for each vertex
    std::uint32_t vertex_count;    // vertices, not numbers
    const std::uint32_t* indices;  // three for each triangle
    std::uint32_t index_count;
    float color[3];           // linear RGB
    float emissive;           // Look::emissive
    float opacity;            // [0, 1]
    float gloss;              // 0 chalk .. 1 polished
    hh_vec3 center;           // offset of the positions
    std::uint32_t is_moving;  // 0: the body is static
};

struct PageLamp {
    hh_vec3 position;
    float color[3];  // linear RGB times the intensity at 1 m
    float reach_m;
};

// Loads what the server's offer names, its first message, with all players. Null, or why it cannot
// be played here: no server, another version, a scene that is not built in, or the digest that
// differs. Call it once, before all others.
const char* page_load(const void* offer, std::size_t size);
hh_world* page_world(void);
const char* page_scene(void);
std::uint32_t page_player_count(void);
void page_player(std::uint32_t slot, hh_player* player);
// Lists of PageVisual and PageLamp; the scene keeps them.
std::uint32_t page_visuals(const PageVisual** visuals);
std::uint32_t page_lamps(const PageLamp** lamps);
// The body's name.
const char* page_body_name(const hh_body* body);

// A connection has opened. `person`: random, the same when the person returns. `now_s`: a clock
// that only runs forward, that of page_poll.
void page_connect(std::uint64_t person, const char* token, double now_s);
// A message of the server; it is read in the next page_poll.
void page_receive(const void* message, std::size_t size);
// The connection has ended.
void page_closed(const char* why);
// Steps the ticks that are due. `input`: what the devices have said since the last call, with times
// before now, seconds, at most 0: they end with the last tick that is due. `wrists`: bit 1 << side
// is set if that hand's poses are wrists instead of controllers. While no tick is due, samples and
// buttons are ignored; snap turns wait for the next tick. Returns the number of ticks, or -1 for a
// defect (page_why).
std::int32_t page_poll(double now_s, const hh_match_input* input, std::uint32_t wrists);
// hh_match_drawn_player of the page's match. `wrists`: as of page_poll, for `newest`.
hh_result page_drawn_player(std::uint32_t slot, const hh_tracking_sample* newest,
                            std::uint32_t wrists, hh_pose* origin, hh_pose* head, hh_pose* left,
                            hh_pose* right);
// The next message to the server, 0 bytes: none is left.
std::size_t page_next_message(const void** message);
void page_leave(void);

// PeerStage: 0 connecting, 1 offered, 2 joining, 3 playing, 4 ended.
std::uint32_t page_stage(void);
// Why the match has ended for this peer.
const char* page_why(void);
// 1: another connection may bring the player back.
std::uint32_t page_may_return(void);
std::uint32_t page_slot(void);
// States that were restored.
std::uint32_t page_states(void);
// Null before the first state.
const hh_match* page_match(void);
// "blue 2 : 1 orange", or "" in a scene without rules.
const char* page_score(void);
}  // extern "C"
}  // namespace handhold
