#pragma once

#include <cstdint>
#include <optional>

#include "engine/collision/bullet_separation.hpp"

// When a moving convex shape first touches a resting one.
// Source: Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996 (conservative
// advancement).
namespace handhold {

// The way of a relative to b, in near space; its place goes along a line, its rotation along the
// shorter arc.
class RelativeMotion {
  public:
    RelativeMotion(const Pose& from_ns, const Pose& to_ns);

    Pose at(double fraction) const;
    const Vec3& from_ns() const { return from_.position; }
    const Vec3& move() const { return move_; }  // of the centre, over the whole way
    const Vec3& turn_rad() const {
        return turn_;
    }  // rotation vector over the whole way, in near space
    // Velocity, over the whole way, of the point of a that is at `point` at that fraction of it.
    Vec3 velocity_at(const Vec3& point_ns, double fraction) const;

  private:
    Pose from_;
    Pose to_;
    Vec3 move_;
    Vec3 turn_;
};

struct Impact {
    double fraction = 0.0;           // of the way, in [0, 1]
    Vec3 normal = Vec3::UnitY();     // unit, from b towards a
    Vec3 point_b_ns = Vec3::Zero();  // on b's surface
    std::uint32_t part = 0;          // of a; whoever asks about several writes it
};

// How far a part of what moves is known to go without touching a resting shape.
struct Approach {
    double fraction = 0.0;
    Impact impact;  // of the last search for what keeps them apart; where they touch: the touch
    double gap_m = 0.0;  // then
    int steps = 0;
};
enum class ApproachState : std::uint8_t { continues, touches, misses };
// The first step, cheap, and the others, each from the last one's fraction to one that no point of
// a can outrun: many shapes are so met at a time, whichever is nearest first. `limit` as below.
std::optional<Approach> begin_approach(const ConvexPart& a, const RelativeMotion& motion,
                                       const Convex& b, double limit);
ApproachState advance(const ConvexPart& a, const RelativeMotion& motion, const Convex& b,
                      double limit, Approach& approach);

// First fraction of the way at which a, a part of what moves, is within a micrometre of b, or
// nullopt where it is not before `limit`. A start in touch is an impact at 0.
std::optional<Impact> time_of_impact(const ConvexPart& a, const RelativeMotion& motion,
                                     const Convex& b, double limit);

}  // namespace handhold
