#pragma once

#include <cstdint>
#include <optional>

#include "engine/collision/bullet_separation.hpp"

// Time of impact of a moving convex shape with a resting one, by conservative advancement. All
// values are in near space (suffix _ns): b's axes with the origin at a's position. Source: Mirtich,
// Impulse-based Dynamic Simulation of Rigid Body Systems, 1996.
namespace handhold {

// Motion of a relative to b over a frame, in near space. The position moves linearly, the rotation
// along the shorter arc.
class RelativeMotion {
  public:
    RelativeMotion(const Pose& from_ns, const Pose& to_ns);

    Pose at(double fraction) const;
    const Vec3& from_ns() const { return from_.position; }
    const Vec3& move() const { return move_; }  // displacement of a's origin
    // Rotation vector of the whole motion.
    const Vec3& turn_rad() const { return turn_; }
    // Velocity of a's material point that is at `point_ns` at `fraction`, in metres per whole
    // motion.
    Vec3 velocity_at(const Vec3& point_ns, double fraction) const;

  private:
    Pose from_;
    Pose to_;
    Vec3 move_;
    Vec3 turn_;
};

struct Impact {
    double fraction = 0.0;           // fraction of the motion, [0, 1]
    Vec3 normal = Vec3::UnitY();     // unit, from b towards a
    Vec3 point_b_ns = Vec3::Zero();  // point on b's surface
    std::uint32_t part = 0;          // index of a's part; written by the caller
};

// Where a sweep ends.
struct SweepLimit {
    double fraction = 1.0;  // share of the motion after which no touch is searched
    // A touch after which the shapes can overlap by no more than this until the end of the motion
    // may be left out.
    double grazing_m = 0.0;
};

// State of a conservative advancement: the fraction of the motion for which a part is known not to
// touch a resting shape.
struct Approach {
    double fraction = 0.0;
    Impact impact;       // once `touches`: the contact; before, only its normal is used
    double gap_m = 0.0;  // separation at that query
    int steps = 0;
};
enum class ApproachState : std::uint8_t { continues, touches, misses };
// begin_approach takes cheap first steps. It returns nullopt only if a does not touch b before the
// limit, or if the touch may be left out (SweepLimit::grazing_m). advance moves to a later
// fraction, up to which a cannot touch b; it reports `misses` on the same conditions. A caller with
// many shapes always advances the one with the smallest fraction.
std::optional<Approach> begin_approach(const ConvexPart& a, const RelativeMotion& motion,
                                       const Convex& b, const SweepLimit& limit);
ApproachState advance(const ConvexPart& a, const RelativeMotion& motion, const Convex& b,
                      const SweepLimit& limit, Approach& approach);

// First fraction of the motion at which part a comes within a micrometre of b; 0 if they touch at
// the start. nullopt if there is no touch before the limit, or if the touch may be left out
// (SweepLimit::grazing_m).
std::optional<Impact> time_of_impact(const ConvexPart& a, const RelativeMotion& motion,
                                     const Convex& b, const SweepLimit& limit);

}  // namespace handhold
