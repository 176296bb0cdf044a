#include "game/arena/arena_game.hpp"

#include <algorithm>
#include <cmath>

#include <handhold/math.hpp>

namespace handhold {
namespace {

constexpr std::uint32_t k_faces = 10;
constexpr double k_face_rad = 6.283185307179586 / k_faces;
constexpr double k_outside_m = 1.0;  // beyond the arena's walls

void put(std::uint64_t value, std::size_t size, std::vector<std::byte>& bytes) {
    for (std::size_t i = 0; i < size; ++i) {
        bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xffU));
    }
}
std::uint64_t take(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
        value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
    }
    return value;
}

bool is_outside(const hh::Vec3& point_ws) {
    const double radius_m = k_arena_radius_m + k_outside_m;
    return std::abs(point_ws.z) > k_arena_half_length_m + k_outside_m ||
           point_ws.x * point_ws.x + point_ws.y * point_ws.y > radius_m * radius_m;
}

}  // namespace

hh::Vec3 goal_of(ArenaTeam team) {
    return {0.0, 0.0, team == ArenaTeam::blue ? k_goal_z_m : -k_goal_z_m};
}

std::optional<ArenaTeam> scores_at(const hh::Vec3& point_ws) {
    const bool is_in_circle =
        point_ws.x * point_ws.x + point_ws.y * point_ws.y < k_goal_radius_m * k_goal_radius_m;
    if (!is_in_circle || std::abs(point_ws.z) < k_goal_z_m ||
        std::abs(point_ws.z) > k_arena_half_length_m) {
        return std::nullopt;
    }
    return point_ws.z > 0.0 ? ArenaTeam::orange : ArenaTeam::blue;
}

// FNV-1a, 64 bits, of the numbers' bytes. No memory is allocated.
std::uint64_t ArenaState::hash() const {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    const std::array<std::uint64_t, 4> numbers = {score[0], score[1], goal_tick, reset_tick};
    for (const std::uint64_t number : numbers) {
        for (unsigned shift = 0; shift < 64; shift += 8) {
            hash = (hash ^ ((number >> shift) & 0xffU)) * 0x100000001b3ULL;
        }
    }
    return hash;
}

void write_arena_state(const ArenaState& state, std::vector<std::byte>& bytes) {
    put(state.score[0], 4, bytes);
    put(state.score[1], 4, bytes);
    put(state.goal_tick, 8, bytes);
    put(state.reset_tick, 8, bytes);
    put(state.hash(), 8, bytes);
}

std::optional<ArenaState> read_arena_state(std::span<const std::byte> bytes) {
    if (bytes.size() != k_arena_state_bytes) {
        return std::nullopt;
    }
    ArenaState state;
    state.score = {static_cast<std::uint32_t>(take(bytes, 0, 4)),
                   static_cast<std::uint32_t>(take(bytes, 4, 4))};
    state.goal_tick = take(bytes, 8, 8);
    state.reset_tick = take(bytes, 16, 8);
    return take(bytes, 24, 8) == state.hash() ? std::optional(state) : std::nullopt;
}

hh::Pose drum_pose(const ArenaDrum& drum, std::uint32_t score) {
    const std::uint32_t digit = score / drum.divisor % k_faces;
    return {drum.center_ws, hh::rotation_about(hh::k_y, drum.facing_rad) *
                                hh::rotation_about(hh::k_x, digit * k_face_rad)};
}

void ArenaGame::step(const ArenaPlan& plan, hh::World& world, std::uint64_t tick,
                     ArenaState& state) {
    const auto disc = world.pose(plan.disc);
    if (!disc) {
        return;
    }
    const std::optional<ArenaTeam> scorer = scores_at(disc->position);
    if (!scorer && !is_outside(disc->position)) {
        return;
    }
    state.reset_tick = tick;
    (void)world.teleport(plan.disc, hh::k_origin);
    (void)world.set_velocity(plan.disc, {}, {});
    if (!scorer) {
        return;
    }
    state.goal_tick = tick;
    ++state.score[static_cast<std::size_t>(*scorer)];
    for (const ArenaDrum& drum : plan.drums) {
        if (drum.team == *scorer) {
            (void)world.teleport(drum.body,
                                 drum_pose(drum, state.score[static_cast<std::size_t>(*scorer)]));
        }
    }
}

void ArenaGame::read_boards(const hh::World& world) {
    state = {};
    std::array<std::uint32_t, k_arena_teams * 2> digits{};
    for (const ArenaDrum& drum : plan.drums) {
        const auto pose = world.pose(drum.body);
        if (!pose) {
            continue;
        }
        std::uint32_t shown = 0;
        double nearest = -1.0;
        for (std::uint32_t digit = 0; digit < k_faces; ++digit) {
            const hh::Quat face = drum_pose(drum, digit * drum.divisor).rotation;
            const hh::Vec3 up = pose->rotation * hh::k_y;
            const double likeness = hh::dot(face * hh::k_y, up);
            if (likeness > nearest) {
                nearest = likeness;
                shown = digit;
            }
        }
        digits[2 * static_cast<std::size_t>(drum.team) + (drum.divisor == 1 ? 0 : 1)] = shown;
    }
    state.score = {digits[0] + 10 * digits[1], digits[2] + 10 * digits[3]};
}

ArenaTeam team_of(std::size_t player_index) {
    return player_index % k_arena_teams == 0 ? ArenaTeam::blue : ArenaTeam::orange;
}

ArenaTeam team_of(const hh::World& world, hh::Player player) {
    const std::vector<hh::Player> players = world.players();
    const auto at = std::ranges::find(players, player);
    return team_of(static_cast<std::size_t>(at - players.begin()));
}

std::string score_text(const ArenaState& state) {
    return "blue " + std::to_string(state.score[0]) + " : " + std::to_string(state.score[1]) +
           " orange";
}

}  // namespace handhold
