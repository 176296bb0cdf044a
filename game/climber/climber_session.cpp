#include "game/climber/climber_session.hpp"

#include <algorithm>
#include <cstdio>

#include "engine/core/check.hpp"
#include "engine/io/printable.hpp"
#include "game/commands/exit_status.hpp"
#include "game/commands/loading.hpp"
#include "game/scene/place_scene.hpp"
#include "game/session/interrupt.hpp"
#include "systems/frame.hpp"

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

int climb_command(const ClimbOptions& options) {
    const InterruptGuard interrupts;
    Result<Scene> loaded = load_scene_with_progress(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    Scene& scene = loaded.value();
    print_notes(scene.notes);
    ClimbPlan plan;
    plan.seconds = options.seconds;
    plan.seed = options.seed;
    bool found = options.spawn.empty() && scene.spawns.empty();
    for (const SceneSpawnPoint& spawn : scene.spawns) {
        if (!found && (options.spawn.empty() || spawn.name == options.spawn)) {
            plan.origin_ws = spawn.pose_ws;
            found = true;
        }
    }
    if (!found) {
        return refuse({options.scene, "/spawns",
                       "expected a spawn \"" + options.spawn + "\", found none of that name"});
    }
    const Recording recording = record_climb(scene, plan);
    if (const auto error = save_recording(options.out, recording)) {
        return refuse(*error);
    }
    std::printf("%s: %zu samples over %.2f s\n", printable(options.out).c_str(),
                recording.samples.size(), recording.samples.back().t_s);
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace handhold
