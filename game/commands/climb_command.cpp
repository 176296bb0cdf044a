#include "game/commands/climb_command.hpp"

#include <cstdio>

#include "engine/core/printable.hpp"
#include "game/climber/climber_session.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {

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
