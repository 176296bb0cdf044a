// The README's sample: a player who grips a wall and stays there, hand exact.
#include <cstdio>

#include <handhold/handhold.hpp>

using namespace handhold;

namespace {

// The headset and both controllers at `t_s`; the right palm faces the wall and closes at 0.5 s.
TrackingSample devices_at(double t_s) {
    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
    const Quat palm_to_wall(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitX()));
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const auto side = static_cast<HandSide>(i);
        const Vec3 wrist_ps(side == HandSide::right ? 0.2 : -0.2, 1.4, -0.43);
        const Pose hand_in_controller = default_controller_to_hand(side, HandTuning{});
        sample.controllers[i].controller_ps =
            Pose{wrist_ps, palm_to_wall} * inverse(hand_in_controller);
        sample.controllers[i].grab = side == HandSide::right && t_s >= 0.5;
    }
    return sample;
}

}  // namespace

int main() {
    // [grip]
    World world;
    ShapeLibrary shapes;
    Tuning tuning;
    BodyDescription wall;
    wall.name = "wall";
    wall.pose_ws.position = Vec3(0.0, 1.5, -0.6);
    wall.shape = shapes.add_box(Vec3(2.0, 2.0, 0.1));  // half extents, metres
    add_body(world, wall);
    PlayerDescription you;
    you.name = "you";
    you.head_shape = shapes.add_sphere(tuning.head.radius_m);
    const PlayerEntities player = add_player(world, you);

    FrameCaches caches(shapes);
    StageStats stats;
    while (world.clock.t_s < 1.0) {
        const TrackingSample sample = devices_at(world.clock.t_s + 1.0 / 90.0);
        const PlayerInput input{player.player, {&sample, 1}, {}};
        step_frame(world, caches, tuning, {1.0 / 90.0, {&input, 1}}, stats);
    }
    const RenderPose& shown = world.render_pose.at(player.player);  // what your renderer draws
    // [grip]
    const bool grips = shown.hands[index_of(HandSide::right)].grip == GripKind::surface;
    std::printf("grips: %d, hand error %.1e m\n", grips ? 1 : 0, stats.hand_error_m);
    return grips && stats.hand_error_m < 1e-6 ? 0 : 1;
}
