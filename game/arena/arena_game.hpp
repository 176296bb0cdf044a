#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <handhold/handhold.hpp>

// The rules of the scene "arena": two teams, two goals, one disc. A goal counts at the first tick
// after which the disc's centre is inside a goal; the disc then returns to the middle at rest.
// Deterministic: a step depends on the world, the state and the tick only.
namespace handhold {

enum class ArenaTeam : std::uint8_t { blue, orange };
inline constexpr std::size_t k_arena_teams = 2;
inline ArenaTeam other_team(ArenaTeam team) {
    return team == ArenaTeam::blue ? ArenaTeam::orange : ArenaTeam::blue;
}

// The goals are circles across the arena's axis, which is Z; blue defends the one at +Z.
inline constexpr double k_arena_half_length_m = 20.0;
inline constexpr double k_arena_radius_m = 6.0;
inline constexpr double k_goal_z_m = 17.6;
inline constexpr double k_goal_radius_m = 1.5;  // radius of the opening
// Centre of the goal that `team` defends, in the world.
hh::Vec3 goal_of(ArenaTeam team);
// The team that scores with the disc's centre at this point; nullopt: nobody.
std::optional<ArenaTeam> scores_at(const hh::Vec3& point_ws);

struct ArenaState {
    std::array<std::uint32_t, k_arena_teams> score{};  // indexed by ArenaTeam
    std::uint64_t goal_tick = 0;                       // tick of the last goal; 0: none yet
    std::uint64_t reset_tick = 0;  // tick of the disc's last return to the middle; 0: none yet

    std::uint64_t hash() const;
    friend bool operator==(const ArenaState&, const ArenaState&) = default;
};
// Score, ticks and a checksum.
inline constexpr std::size_t k_arena_state_bytes = 32;
void write_arena_state(const ArenaState& state, std::vector<std::byte>& bytes);
// nullopt for bytes that write_arena_state has not written.
std::optional<ArenaState> read_arena_state(std::span<const std::byte> bytes);

// A digit of a score board: a kinematic drum about X with ten faces.
struct ArenaDrum {
    hh::Body body{};
    hh::Vec3 center_ws{};
    double facing_rad = 0.0;  // rotation about Y; 0 faces +Z
    ArenaTeam team = ArenaTeam::blue;
    std::uint32_t divisor = 1;  // 1: units, 10: tens
};
hh::Pose drum_pose(const ArenaDrum& drum, std::uint32_t score);

// What the rules need of the scene. Constant.
struct ArenaPlan {
    hh::Body disc{};
    std::vector<ArenaDrum> drums;
};

struct ArenaGame {
    ArenaPlan plan;
    ArenaState state;

    // Call after each step of the world, which ended with `tick`.
    void step(hh::World& world, std::uint64_t tick) { step(plan, world, tick, state); }
    static void step(const ArenaPlan& plan, hh::World& world, std::uint64_t tick,
                     ArenaState& state);
    // After a snapshot was restored: takes the score, modulo 100, from the boards.
    void read_boards(const hh::World& world);
};

// The team of each player by the order in which they were added: blue, orange, blue, ...
ArenaTeam team_of(std::size_t player_index);
ArenaTeam team_of(const hh::World& world, hh::Player player);
// "blue 2 : 1 orange"
std::string score_text(const ArenaState& state);

}  // namespace handhold
