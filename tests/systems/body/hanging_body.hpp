#pragma once

#include <optional>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "systems/body/propagate_spine.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::test {

// A player of average size whose hands may grip, in empty space or beside a box.
struct HangingBody {
    static constexpr std::uint64_t k_own_id = 7;
    static constexpr std::uint64_t k_box_id = 9;

    ShapeLibrary shapes;
    std::optional<CollisionWorld> collision;
    SurfaceQuery surfaces;  // asked instead of `collision`, if set
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<BodyMeasures> measures;
    Column<HeadTracking> head;
    Column<PersistentId> id;
    Column<ArmEstimate> estimate;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<SpineMemory> memory;
    Column<SpinePose> pose;
    Column<BodyHold> no_holds;
    SpineTuning tuning;
    double t_s = 0.0;

    HangingBody() {
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        measures.add(k_player);
        measures.at(k_player).eye_height_m = k_scale_eye_m;
        head.add(k_player);
        head.at(k_player).pose_ps.position = Vec3(0.0, 1.65, -0.08);
        id.add(k_player, {k_own_id});
        estimate.add(k_player);
        estimate.at(k_player).chest_ps.position = Vec3(0.0, 1.4, 0.0);
        owner.add(k_left, {k_player, HandSide::left});
        owner.add(k_right, {k_player, HandSide::right});
        grab.add(k_left);
        grab.add(k_right);
        memory.add(k_player);
        pose.add(k_player);
        put_hand(HandSide::left, Vec3(-0.2, -0.4, -0.1));
        put_hand(HandSide::right, Vec3(0.2, -0.4, -0.1));
    }
    double arm_m() const {
        const BodyMeasures& m = measures.at(k_player);
        return m.upper_arm_m + m.forearm_m;
    }
    void put_hand(HandSide side, const Vec3& from_chest_m) {
        ArmEstimate& e = estimate.at(k_player);
        e.arms[index_of(side)].hand_ps.position = e.chest_ps.position + from_chest_m;
    }
    void grip(HandSide side, bool grips) {
        grab.at(side == HandSide::left ? k_left : k_right).kind =
            grips ? GripKind::surface : GripKind::none;
    }
    void put_box(const Vec3& half_m, const Pose& pose_ws) {
        const ShapeId shape = shapes.add_box(half_m);
        collision.emplace(shapes);
        const std::vector<ColliderProxy> proxies = {{k_box_id, shape, pose_ws, pose_ws, false}};
        collision->set_proxies(proxies);
    }
    const SpinePose& step(double dt_s) {
        t_s += dt_s;
        propagate_spine({.dt_s = dt_s,
                         .t_s = t_s,
                         .surfaces = surfaces || !collision ? surfaces : SurfaceQuery(*collision),
                         .persistent_id = id,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .head = head,
                         .measures = measures,
                         .estimate = estimate,
                         .owner = owner,
                         .grab = grab,
                         .body_hold = no_holds,
                         .memory = memory,
                         .pose = pose},
                        tuning);
        return pose.at(k_player);
    }
    const SpinePose& run(double seconds, double hz = 90.0) {
        for (int i = 0; i < static_cast<int>(seconds * hz + 0.5); ++i) {
            step(1.0 / hz);
        }
        return pose.at(k_player);
    }
};

// The positions of all joints below the chest.
inline std::vector<Vec3> joints_of(const SpinePose& pose) {
    std::vector<Vec3> joints;
    for (const Pose& link : pose.spine_ws) {
        joints.push_back(link.position);
    }
    joints.push_back(pose.pelvis_ws.position);
    for (const SpinePose::Leg& leg : pose.legs) {
        joints.push_back(leg.thigh_ws.position);
        joints.push_back(leg.shin_ws.position);
        joints.push_back(leg.foot_ws.position);
    }
    return joints;
}

}  // namespace handhold::test
