#include <cstdio>
#include <memory>

#include "game/commands/match_commands.hpp"
#include "game/commands/match_entry.hpp"
#include "game/net/match_replay.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/progress.hpp"
#include "game/report/run_summary.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {

int replay_command(const ReplayOptions& options) {
    const InterruptGuard interrupts;
    const Result<MatchRecording> recording = load_match_recording(options.file);
    if (!recording) {
        return refuse(recording.error());
    }
    const MatchOffer& level = recording.value().level;
    Result<MatchScene> made = load_entry_scene({options.file, options.scene, ""}, level);
    if (!made) {
        return refuse(made.error());
    }
    Scene& scene = made.value().scene;
    MatchReplay replay(scene.host, made.value().players, scene.arena ? &*scene.arena : nullptr,
                       recording.value(), k_match_tick_s);
    std::uint64_t ticks = 0;
    {
        Progress progress("playing " + printable(level.scene));
        const double last = static_cast<double>(recording.value().last_tick);
        while (!is_interrupted() &&
               (options.seconds == 0.0 ||
                static_cast<double>(ticks) * k_match_tick_s < options.seconds)) {
            const Result<bool> stepped = replay.step(false);
            if (!stepped) {
                return refuse(stepped.error());
            }
            if (!stepped.value()) {
                break;
            }
            ++ticks;
            progress.show(last > 0.0 ? static_cast<double>(replay.tick()) / last : 1.0);
        }
    }
    std::printf("played %llu ticks to tick %llu; %llu hashes of the recording are equal\n",
                static_cast<unsigned long long>(ticks),
                static_cast<unsigned long long>(replay.tick()),
                static_cast<unsigned long long>(replay.compared()));
    if (scene.arena) {
        std::printf("score: %s\n", score_text(scene.arena->state).c_str());
    }
    std::printf("state_hash %s\n", format_hash(*replay.match().hash(replay.tick())).c_str());
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace handhold
