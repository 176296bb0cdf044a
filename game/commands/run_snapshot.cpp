#include "game/commands/run_snapshot.hpp"

#include <string>

#include "game/session/interrupt.hpp"

namespace handhold {

void SnapshotTaker::watch(const Scene& scene, double t_s) {
    constexpr double k_rounding_s = 1e-9;
    if (!options_.snapshot.empty() && !taken_ && t_s >= options_.snapshot_at_s - k_rounding_s) {
        taken_ = true;
        error_ = save_snapshot_file(options_.snapshot, scene.world(), assets_);
    }
}

std::optional<FileError> SnapshotTaker::error() const {
    if (!options_.snapshot.empty() && !taken_ && !is_interrupted()) {
        return FileError{options_.snapshot, "",
                         "expected a time within the session for --snapshot-at, found " +
                             std::to_string(options_.snapshot_at_s)};
    }
    return error_;
}

std::optional<FileError> resume_from_snapshot(const RunOptions& options,
                                              const RunSettings& settings,
                                              const SnapshotAssets& assets, Scene& scene,
                                              std::vector<PlayerEntities>& players) {
    const bool has_climbers = settings.climbers_from < players.size();
    if (has_climbers && !(options.snapshot.empty() && options.resume.empty())) {
        return FileError{options.scene, "",
                         "expected no scripted climbers with --snapshot and --resume, found " +
                             std::to_string(players.size() - settings.climbers_from)};
    }
    if (options.resume.empty()) {
        return std::nullopt;
    }
    const World before = scene.world();
    if (std::optional<FileError> error =
            load_snapshot_file(options.resume, assets, scene.world())) {
        return error;
    }
    if (scene.arena) {
        scene.arena->read_boards(scene.host);
    }
    bool all_there = scene.world().player.size() == players.size();
    const auto find_again = [&](Entity& entity) {
        entity = find_by_id(scene.world(), before.persistent_id.at(entity));
        all_there = all_there && !is_null(entity);
    };
    for (PlayerEntities& player : players) {
        find_again(player.player);
        for (Entity& hand : player.hands) {
            find_again(hand);
        }
    }
    if (!all_there) {
        return FileError{options.resume, "",
                         "expected a snapshot with the players of this run, found others"};
    }
    return std::nullopt;
}

}  // namespace handhold
