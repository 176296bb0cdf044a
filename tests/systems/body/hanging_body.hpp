#pragma once

#include <optional>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "tests/systems/body/body_columns.hpp"

namespace handhold::test {

// A player of average size whose hands may grip, in empty space or beside a box.
struct HangingBody : BodyColumns {
    static constexpr std::uint64_t k_own_id = 7;
    static constexpr std::uint64_t k_box_id = 9;

    ShapeLibrary shapes;
    std::optional<CollisionWorld> collision;
    SurfaceQuery surfaces;  // asked instead of `collision`, if set

    HangingBody() {
        add_player();
        measures.at(k_player).eye_height_m = k_scale_eye_m;
        head.at(k_player).pose_ps.position = Vec3(0.0, 1.65, -0.08);
        id.add(k_player, {k_own_id});
        estimate.at(k_player).chest_ps.position = Vec3(0.0, 1.4, 0.0);
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
        propagate_spine(dt_s, surfaces || !collision ? surfaces : SurfaceQuery(*collision));
        return spine_pose.at(k_player);
    }
    const SpinePose& run(double seconds, double hz = 90.0) {
        for (int i = 0; i < static_cast<int>(seconds * hz + 0.5); ++i) {
            step(1.0 / hz);
        }
        return spine_pose.at(k_player);
    }
};

}  // namespace handhold::test
