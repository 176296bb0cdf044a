#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "systems/frame/frame.hpp"
#include "systems/match/shared/match_input.hpp"

namespace handhold {

// The inputs of all slots in one tick, and those used in the tick before.
struct TickInputs {
    std::array<const MatchInput*, k_most_match_players> before{};
    std::array<const MatchInput*, k_most_match_players> now{};
};

// What a session's host adds to the ticks, for state of its own that goes back and forth with the
// world's. `context` is passed to each function. Null functions are not called.
struct MatchHost {
    void* context = nullptr;
    // In place of step_frame (is_shown) or step_simulated: runs it, and what the host adds.
    void (*step)(void* context, const FrameInput& input, const TickInputs& inputs,
                 bool is_shown) = nullptr;
    // Keeps a copy of the host's state in `place`, [0, k_match_window), and returns to it.
    void (*keep)(void* context, std::size_t place) = nullptr;
    void (*restore)(void* context, std::size_t place) = nullptr;
    // Hash of the host's state.
    std::uint64_t (*hash)(void* context) = nullptr;
    // What else than the world a joining player needs. `read` gets bytes that `write` wrote, or
    // any others: it returns false for these, and changes nothing until `joined`, which follows
    // once the world is replaced.
    void (*write)(void* context, std::vector<std::byte>& bytes) = nullptr;
    bool (*read)(void* context, std::span<const std::byte> bytes) = nullptr;
    void (*joined)(void* context) = nullptr;
};

// Number of states that a client keeps, one a tick. It is fewer ticks than this after the last
// confirmed one.
inline constexpr std::size_t k_match_window = 64;

// The world of a match on one machine. All of it must outlive the session that has it.
struct MatchWorld {
    World& world;
    FrameCaches& caches;
    const Tuning& tuning;
    double dt_s = 1.0 / 90.0;  // length of a tick
    // The match's players; the index is the player's slot. All are in the world, also while nobody
    // plays them.
    std::array<PersistentId, k_most_match_players> players{};
    std::size_t player_count = 0;
    MatchHost host{};
};

// Scratch memory of step_tick, too large for a small stack.
struct TickScratch {
    std::array<TickSamples, k_most_match_players> samples;
    std::array<PlayerInput, k_most_match_players> players;
};

// Steps the world by one tick, with the host's step, step_frame or step_simulated. Players that are
// not in the world are left out.
void step_tick(const MatchWorld& match, const TickInputs& inputs, bool is_shown,
               TickScratch& scratch, StageStats& stats);
// Hash of the host's state; 0 without one.
std::uint64_t hash_of_host(const MatchWorld& match);
// What the machines compare: hash_simulated of the world and, if there is one, the host's hash.
std::uint64_t match_hash(const MatchWorld& match, std::uint64_t world_hash,
                         std::uint64_t host_hash);

}  // namespace handhold
