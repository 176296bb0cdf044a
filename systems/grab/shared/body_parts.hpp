#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "components/body_part.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "engine/math/math.hpp"
#include "systems/rigs/body_capsules.hpp"

// Finds the parts of bodies that a hand can grip.
namespace handhold {

// How far follow_part moves the pose: `share` of the way, in [0, 1], but the anchor by at most
// `max_m`.
struct PartStep {
    double share = 1.0;
    double max_m = 0.0;
};
// Moves `from_ps` towards `to_ps`, the rotation by the same share as the position. The point
// `anchor_bs` travels on a straight line.
Pose follow_part(const Pose& from_ps, const Pose& to_ps, const Vec3& anchor_bs,
                 const PartStep& step);

// A point on a part. `normal_ws`: unit, outward.
struct PartHit {
    std::uint64_t id = 0;  // id of the player
    BodyPart part = BodyPart::left_upper_arm;
    Vec3 point_ws = Vec3::Zero();
    Vec3 normal_ws = Vec3::UnitY();
    double distance_m = 0.0;  // distance from the ray's start or the query point; negative: inside
};

// The bodies of players at the start of the frame. A player who is not in `bodies` has no body that
// can be gripped.
struct GrippableBodies {
    const Column<GrippableBody>& bodies;
    const Column<BodyMeasures>& measures;  // has every player of `bodies`
    const Column<PersistentId>& persistent_id;
    const Column<PlayerOrigin>& origin;
    const Column<HeadTracking>& head;

    // The part's frame in its player's play space. Precondition: the player is in `bodies`.
    Pose part_ps(Entity player, BodyPart part) const;

    // The queries return the nearest part; among equally near ones, that of the player with the
    // smallest id. Players in `skip` are ignored. A ray that starts inside a part does not hit that
    // part.
    using Skip = std::span<const std::uint64_t>;
    std::optional<PartHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws, Skip skip) const;
    std::optional<PartHit> closest_point(const Vec3& point_ws, double max_distance_m,
                                         Skip skip) const;

  private:
    template <typename Test>
    std::optional<PartHit> nearest(const Vec3& near_ws, double within_m, Skip skip,
                                   const Test& test) const;
};

}  // namespace handhold
