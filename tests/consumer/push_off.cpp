// A host of the runtime in a hundred lines: a wall, a player who grips it, pushes himself off and
// drifts. A real host takes the samples from its headset and draws RenderPose.
#include <cmath>
#include <cstdio>
#include <vector>

#include <handhold/ecs.hpp>

namespace {

using namespace handhold;

constexpr double k_dt_s = 1.0 / 90.0;
constexpr double k_grip_s = 0.5;  // the right hand closes,
constexpr double k_push_s = 1.0;  // goes towards the wall,
constexpr double k_open_s = 1.3;  // opens while it does,
constexpr double k_stop_s = 1.4;  // and stops
constexpr double k_end_s = 2.3;
constexpr double k_push_mps = 1.0;

// The wall's face is at z = -0.5, its normal +Z.
void add_wall(World& world, ShapeLibrary& shapes) {
    BodyDescription wall;
    wall.name = "wall";
    wall.pose_ws.position = Vec3(0.0, 1.5, -0.6);
    wall.shape = shapes.add_box(Vec3(2.0, 2.0, 0.1));
    add_body(world, wall);
}

// What the devices say at a time: the head looks at the wall, the right palm faces it.
TrackingSample devices_at(double t_s, const HandTuning& tuning) {
    const Quat palm_to_wall(Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Vec3::UnitX()));
    const double pushed_m = k_push_mps * (std::fmin(std::fmax(t_s, k_push_s), k_stop_s) - k_push_s);
    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const auto side = static_cast<HandSide>(i);
        Pose hand_ps{Vec3(side == HandSide::right ? 0.2 : -0.2, 1.4, -0.43), palm_to_wall};
        if (side == HandSide::right) {
            hand_ps.position.z() -= pushed_m;
        }
        ControllerSample& controller = sample.controllers[i];
        controller.controller_ps = hand_ps * inverse(default_controller_to_hand(side, tuning));
        controller.grab = side == HandSide::right && t_s >= k_grip_s && t_s < k_open_s;
    }
    return sample;
}

struct Outcome {
    bool gripped = false;
    double hand_error_m = 0.0;  // worst, against its anchor
    double speed_mps = 0.0;     // away from the wall
    double origin_z_m = 0.0;
    std::uint64_t hash = 0;
};

Outcome play() {
    ShapeLibrary shapes;
    World world;
    const Tuning tuning;
    add_wall(world, shapes);
    PlayerDescription description;
    description.name = "player";
    description.head_shape = shapes.add_sphere(tuning.head.radius_m);
    const PlayerEntities player = add_player(world, description);
    FrameCaches caches(shapes);
    StageStats stats;
    Outcome outcome;
    while (world.clock.t_s < k_end_s) {
        const TrackingSample sample = devices_at(world.clock.t_s + k_dt_s, tuning.hand);
        const PlayerInput input{player.player, {&sample, 1}, {}};
        step_frame(world, caches, tuning, {k_dt_s, {&input, 1}}, stats);
        const RenderPose& render = world.render_pose.at(player.player);
        const auto right = index_of(HandSide::right);
        outcome.gripped = outcome.gripped || render.hands[right].grip == GripKind::surface;
        outcome.hand_error_m = std::fmax(outcome.hand_error_m, stats.hand_error_m);
    }
    outcome.speed_mps = world.player_velocity.at(player.player).linear_mps.z();
    outcome.origin_z_m = world.player_origin.at(player.player).pose_ws.position.z();
    outcome.hash = hash_state(world);
    return outcome;
}

}  // namespace

int main() {
    const Outcome outcome = play();
    std::printf("gripped %d, hand within %.1e m, drifts at %.3f m/s, is at z = %.3f m\n",
                outcome.gripped ? 1 : 0, outcome.hand_error_m, outcome.speed_mps,
                outcome.origin_z_m);
    // Closed form: what the hand pushed, then its speed under drag d for the second that is left.
    const double drag = LocomotionTuning{}.drift_drag_per_s;
    const double drifted_s = k_end_s - k_open_s;
    const double speed_mps = k_push_mps * std::exp(-drag * drifted_s);
    const double z_m = k_push_mps * (k_open_s - k_push_s) +
                       k_push_mps * (1.0 - std::exp(-drag * drifted_s)) / drag;
    const bool right = outcome.gripped && outcome.hand_error_m < 1e-4 &&
                       std::fabs(outcome.speed_mps - speed_mps) < 0.01 &&
                       std::fabs(outcome.origin_z_m - z_m) < 0.02 && outcome.hash == play().hash;
    std::printf(right ? "as it should be\n" : "not as it should be: %.3f m/s, z = %.3f m\n",
                speed_mps, z_m);
    return right ? 0 : 1;
}
