#include "game/climber/climber_session.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "game/scene/place_scene.hpp"
#include "game/session/interrupt.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {
namespace {

constexpr double k_hz = 90.0;

ClimberTask task_of(const ClimbPlan& plan, const PlayerEntities& player) {
    ClimberTask task;
    task.player = player;
    task.waypoints = plan.waypoints;
    task.cruise_mps = plan.cruise_mps;
    task.may_leap = plan.may_leap;
    task.picks_up_bodies = false;
    task.single_hand = plan.single_hand;
    return task;
}

}  // namespace

Recording record_climb(Scene& scene, const ClimbPlan& plan) {
    HH_CHECK(scene.world.clock.frame == 0, "the scene has been played", plan.seconds);
    // Recordings contain no stick input, so the use of jets could not be replayed.
    scene.tuning.locomotion.thruster_mps2 = 0.0;
    const PlayerEntities player = add_scene_player(scene, {"player0", plan.origin_ws, 80.0});
    const ClimberTask task = task_of(plan, player);
    ClimberState state = begin_climber(scene, task, plan.seed);
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    std::vector<TrackingSample> samples;
    StageStats stats;
    Recording recording;
    double end_s = plan.seconds;
    while (scene.world.clock.t_s < end_s) {
        place_scene(scene, caches);
        climb({scene, caches.collision}, task, scene.world.clock.t_s + 1.0 / k_hz, state, samples);
        for (const TrackingSample& sample : samples) {
            if (recording.samples.empty() || sample.t_s > recording.samples.back().t_s) {
                recording.samples.push_back(recorded(sample));
            }
        }
        const PlayerInput input{player.player, samples, {}};
        step_frame(scene.world, caches, scene.tuning, {1.0 / k_hz, {&input, 1}}, stats);
        if (is_at_target(task, state)) {
            end_s = std::min(end_s, state.waypoint_since_s + plan.linger_s);
        }
        if (is_interrupted()) {
            break;
        }
    }
    return recording;
}

}  // namespace handhold
