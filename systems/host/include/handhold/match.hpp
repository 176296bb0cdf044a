#pragma once

// Matches in C++20: a thin wrapper over match.h, whose comments hold here too.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/match.h>

namespace hh {

inline hh_match_def match_def() { return hh_default_match_def(); }
// The input of a tick. Points to `samples`, which must live until the call.
inline hh_match_input match_input(std::span<const Sample> samples, std::uint32_t buttons = 0) {
    hh_match_input made = hh_default_match_input();
    made.samples = samples.data();
    made.sample_count = samples.size();
    made.buttons = buttons;
    return made;
}

// A game's own state, which goes back and forth with the world. `State` is a value: copies are
// complete, and it has `std::uint64_t hash() const`. It may allocate.
template <typename State>
class MatchGame {
  public:
    State state;  // state of the world's present tick

    // Called after each step of the world, also when a tick is stepped again: see hh_match_game.
    using Step = std::function<void(State& state, std::uint64_t tick,
                                    std::span<const std::uint32_t> buttons)>;

    // Begins with the state `start`, and steps it by `step`.
    explicit MatchGame(Step step, State start = {})
        : state(std::move(start)), step_(std::move(step)) {}
    MatchGame(const MatchGame&) = delete;
    MatchGame& operator=(const MatchGame&) = delete;

    // Points to this object, which must live as long as the match.
    hh_match_game callbacks() {
        hh_match_game game = hh_default_match_game();
        game.context = this;
        game.step = [](void* self, std::uint64_t tick, const std::uint32_t* buttons,
                       std::size_t count) {
            of(self).step_(of(self).state, tick, {buttons, count});
        };
        game.save = [](void* self, std::uint32_t place) { of(self).kept_[place] = of(self).state; };
        game.restore = [](void* self, std::uint32_t place) {
            of(self).state = of(self).kept_[place];
        };
        game.hash = [](void* self) { return of(self).state.hash(); };
        return game;
    }

  private:
    static MatchGame& of(void* self) { return *static_cast<MatchGame*>(self); }

    Step step_;
    std::array<State, HH_MATCH_PLACES> kept_{};
};

// A world's part in a match. Destroy it before the world. After a failed construction is_valid is
// false and every call fails with HH_ERROR_NULL.
class Match {
  public:
    Match() = default;
    // Begins a match; `def.players` need not be set. Check is_valid().
    Match(World& world, std::span<const Player> players, hh_match_def def,
          const hh_match_game* game = nullptr) {
        def.players = players.data();
        def.player_count = players.size();
        if (hh_match_create(world.get(), &def, game, &match_) != HH_OK) {
            match_ = nullptr;
        }
    }
    ~Match() { hh_match_destroy(match_); }
    // Takes over the match; `other` is empty afterwards.
    Match(Match&& other) noexcept : match_(std::exchange(other.match_, nullptr)) {}
    // Exchanges the two.
    Match& operator=(Match&& other) noexcept {
        std::swap(match_, other.match_);
        return *this;
    }
    // True unless creation failed or the match was moved from.
    bool is_valid() const { return match_ != nullptr; }
    // The handle of the C interface; null if not valid.
    hh_match* get() { return match_; }
    // The handle of the C interface; null if not valid.
    const hh_match* get() const { return match_; }

    // ---- Clients and spectators ----

    // How often to call advance for so much time of the local clock.
    Maybe<std::uint32_t> ticks_due(double elapsed_s) {
        return value<std::uint32_t>(
            [&](auto* out) { return hh_match_ticks_due(match_, elapsed_s, out); });
    }
    // One tick on; false while the world is too far ahead.
    Maybe<bool> advance(const hh_match_input& input) {
        std::uint8_t advanced = 0;
        const hh_result result = hh_match_advance(match_, &input, &advanced);
        return {result, advanced != 0};
    }
    // Takes a packet of the server.
    Status receive(std::span<const std::byte> packet) {
        return hh_match_receive(match_, packet.data(), packet.size());
    }
    // Replaces `packet` by the next packet to the server.
    Status packet(std::vector<std::byte>& packet) {
        packet.resize(HH_MATCH_PACKET_BYTES);
        std::size_t size = 0;
        const hh_result result = hh_match_packet(match_, packet.data(), packet.size(), &size);
        packet.resize(result == HH_OK ? size : 0);
        return result;
    }
    // Replaces the world's state by a server's.
    Status join(std::span<const std::byte> state) {
        return hh_match_join(match_, state.data(), state.size());
    }

    // ---- Servers ----

    // Somebody plays the slot.
    Status connect(std::uint32_t slot) { return hh_match_connect(match_, slot); }
    // Nobody plays the slot: its hands let go and its body floats.
    Status disconnect(std::uint32_t slot) { return hh_match_disconnect(match_, slot); }
    // Takes a packet that came from that slot's player.
    Status receive_from(std::uint32_t slot, double now_s, std::span<const std::byte> packet) {
        return hh_match_receive_from(match_, slot, now_s, packet.data(), packet.size());
    }
    // Confirms and steps what is complete or due; the number of ticks.
    Maybe<std::uint32_t> confirm(double now_s) {
        return value<std::uint32_t>(
            [&](auto* out) { return hh_match_confirm(match_, now_s, out); });
    }
    // Replaces `packet` by the next packet to that slot's player.
    Status packet_to(std::uint32_t slot, std::vector<std::byte>& packet) {
        packet.resize(HH_MATCH_PACKET_BYTES);
        std::size_t size = 0;
        const hh_result result =
            hh_match_packet_to(match_, slot, packet.data(), packet.size(), &size);
        packet.resize(result == HH_OK ? size : 0);
        return result;
    }
    // Replaces `state` by what a player joins with.
    Status state(std::uint32_t slot, std::vector<std::byte>& state) {
        std::size_t size = 0;
        hh_result result = hh_match_state(match_, slot, nullptr, 0, &size);
        state.resize(result == HH_OK ? size : 0);
        if (result == HH_OK) {
            result = hh_match_state(match_, slot, state.data(), state.size(), &size);
        }
        return result;
    }

    // The state that a spectator joins with.
    Status state_to_watch(std::vector<std::byte>& out) { return state(HH_MATCH_NO_SLOT, out); }

    // ---- Servers, clients and spectators ----

    // Replaces `packet` by the confirmed inputs after `after`, which becomes the last tick in it.
    Status confirmed_inputs(std::uint64_t& after, std::vector<std::byte>& packet) const {
        packet.resize(HH_MATCH_INPUTS_BYTES);
        std::size_t size = 0;
        const hh_result result =
            hh_match_confirmed_inputs(match_, after, packet.data(), packet.size(), &size, &after);
        packet.resize(result == HH_OK ? size : 0);
        return result;
    }

    // ---- Sync tests ----

    // One tick on and back again, with an input for each slot. A tick of 0: no difference.
    Maybe<hh_match_difference> sync_test(std::span<const hh_match_input> inputs) {
        return value<hh_match_difference>([&](auto* out) {
            return hh_match_sync_test(match_, inputs.data(), inputs.size(), out);
        });
    }

    // ---- All ----

    // True if the player needs a state of the server.
    Maybe<bool> needs_state(std::uint32_t slot) const {
        std::uint8_t needs = 0;
        const hh_result result = hh_match_needs_state(match_, slot, &needs);
        return {result, needs != 0};
    }
    // Hash of world and game after a tick.
    Maybe<std::uint64_t> hash(std::uint64_t tick) const {
        return value<std::uint64_t>([&](auto* out) { return hh_match_hash(match_, tick, out); });
    }
    // What to add to drawn positions, world, m.
    struct ShownOffsets {
        hh_vec3 head{};                  // offset of the head
        std::array<hh_vec3, 2> hands{};  // indexed by hh_side
    };
    // See hh_match_shown_offsets.
    Maybe<ShownOffsets> shown_offsets(std::uint32_t slot) const {
        return value<ShownOffsets>([&](auto* out) {
            return hh_match_shown_offsets(match_, slot, &out->head, &out->hands[HH_LEFT],
                                          &out->hands[HH_RIGHT]);
        });
    }
    // Poses to draw, world.
    struct DrawnPlayer {
        hh_pose origin{};                // camera rig
        hh_pose head{};                  // pose between the eyes
        std::array<hh_pose, 2> hands{};  // wrists, indexed by hh_side
    };
    // See hh_match_drawn_player. `newest`: null, or the own devices now.
    Maybe<DrawnPlayer> drawn_player(std::uint32_t slot, const Sample* newest = nullptr) const {
        return value<DrawnPlayer>([&](auto* out) {
            return hh_match_drawn_player(match_, slot, newest, &out->origin, &out->head,
                                         &out->hands[HH_LEFT], &out->hands[HH_RIGHT]);
        });
    }
    // Poses of as many bodies; see hh_match_drawn_bodies.
    Status drawn_bodies(std::span<const Body> bodies, std::span<hh_pose> poses) const {
        return poses.size() < bodies.size()
                   ? HH_ERROR_CAPACITY
                   : hh_match_drawn_bodies(match_, bodies.data(), bodies.size(), poses.data());
    }
    // Events of the last call that stepped. Valid until the next one.
    std::span<const hh_match_event> events() const {
        const hh_match_event* events = nullptr;
        std::size_t count = 0;
        return hh_match_events(match_, &events, &count) == HH_OK
                   ? std::span<const hh_match_event>(events, count)
                   : std::span<const hh_match_event>();
    }
    // All zero if the match is not valid.
    hh_match_stats stats() const {
        hh_match_stats stats = hh_default_match_stats();
        (void)hh_match_get_stats(match_, &stats);
        return stats;
    }

  private:
    template <typename T, typename Call>
    static Maybe<T> value(const Call& call) {
        T out{};
        const hh_result result = call(&out);
        return {result, out};
    }

    hh_match* match_ = nullptr;
};

}  // namespace hh
