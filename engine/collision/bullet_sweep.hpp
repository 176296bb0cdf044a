#pragma once

#include <cstdint>
#include <optional>

#include "engine/collision/bullet_separation.hpp"

// Time of impact of a moving convex shape with a resting one, by conservative advancement.
// Source: Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996.
namespace handhold {

// Motion of a relative to b over a frame, in near space: position linear, rotation along the
// shorter arc.
class RelativeMotion {
  public:
    RelativeMotion(const Pose& from_ns, const Pose& to_ns);

    Pose at(double fraction) const;
    const Vec3& from_ns() const { return from_.position; }
    const Vec3& move() const { return move_; }  // displacement of a's origin over the whole motion
    const Vec3& turn_rad() const {
        return turn_;
        // Rotation vector over the whole motion, in near space.
    }
    // Velocity (per whole motion) of the material point of a that is at `point_ns` at `fraction`.
    Vec3 velocity_at(const Vec3& point_ns, double fraction) const;

  private:
    Pose from_;
    Pose to_;
    Vec3 move_;
    Vec3 turn_;
};

struct Impact {
    double fraction = 0.0;           // of the motion, in [0, 1]
    Vec3 normal = Vec3::UnitY();     // unit, from b towards a
    Vec3 point_b_ns = Vec3::Zero();  // on b's surface
    std::uint32_t part = 0;          // index of a's part; written by the caller
};

// State of one conservative advancement: how far a part is known to move without touching a resting
// shape.
struct Approach {
    double fraction = 0.0;
    Impact impact;       // from the last separation query; at a touch, the contact
    double gap_m = 0.0;  // separation at that query
    int steps = 0;
};
enum class ApproachState : std::uint8_t { continues, touches, misses };
// begin_approach is a cheap first step; advance moves on to a fraction that no point of a can
// overshoot. Callers advance whichever of many shapes is nearest. nullopt: never touches before
// `limit`, a fraction of the motion.
std::optional<Approach> begin_approach(const ConvexPart& a, const RelativeMotion& motion,
                                       const Convex& b, double limit);
ApproachState advance(const ConvexPart& a, const RelativeMotion& motion, const Convex& b,
                      double limit, Approach& approach);

// First fraction of the motion at which part a comes within a micrometre of b; nullopt if that does
// not happen before `limit`. If they touch at the start: fraction 0.
std::optional<Impact> time_of_impact(const ConvexPart& a, const RelativeMotion& motion,
                                     const Convex& b, double limit);

}  // namespace handhold
