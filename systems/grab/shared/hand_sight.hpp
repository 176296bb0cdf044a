#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/collision/surface_query.hpp"
#include "engine/math/math.hpp"

namespace handhold {

inline constexpr double k_sight_beyond_m = 0.01;

// Tests what a hand can reach without crossing a wall. `outside_ws`: where the palm was last known
// to be outside of walls; the head is always outside. Bodies in `skip` are no obstacles.
struct SightLines {
    SurfaceQuery surfaces;
    std::span<const std::uint64_t> skip;
    Vec3 outside_ws;
    Vec3 head_ws;
    double scale = 1.0;  // PlayerOrigin::scale

    enum class Sight : std::uint8_t { blocked, clear, clear_beyond };
    // Tests the lines from outside_ws and from head_ws to the palm; one clear line suffices.
    // `clear_beyond`: also nothing is within k_sight_beyond_m times the scale behind the palm on
    // that line.
    Sight sight_of_palm(const Vec3& palm_ws) const;

    // True if the hand may grip `point_ws` of a body: the palm or the point is in sight
    // (`any_point`: some point of that body), or the hand can reach around what blocks the view (a
    // rail, a pipe, the rim of a recess).
    enum class Needs : std::uint8_t { this_point, any_point };
    bool may_grip(const Vec3& palm_ws, const Vec3& point_ws, std::uint64_t body_id,
                  Needs needs) const;

    // The visible surface that a palm was pushed through, as near to the palm as it can be seen.
    std::optional<RayHit> entry(const Vec3& palm_ws) const;

  private:
    bool is_free(const Vec3& from_ws, const Vec3& to_ws) const;
    bool sees(const Vec3& from_ws, const Vec3& point_ws, std::uint64_t body_id, Needs needs) const;
    std::optional<RayHit> entry_from(const Vec3& from_ws, const Vec3& palm_ws) const;
    bool can_go_round(const Vec3& from_ws, const Vec3& palm_ws, std::uint64_t body_id) const;
};

}  // namespace handhold
