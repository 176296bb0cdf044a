#pragma once

#include <optional>
#include <vector>

#include "engine/core/result.hpp"
#include "game/commands/run_command.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/scene.hpp"
#include "systems/snapshot/snapshot.hpp"

// `run --snapshot` and `run --resume`.
namespace handhold {

// Saves the snapshot of --snapshot once its time is reached.
class SnapshotTaker {
  public:
    SnapshotTaker(const RunOptions& options, const SnapshotAssets& assets)
        : options_(options), assets_(assets) {}

    // Call after each frame that ends at `t_s`.
    void watch(const Scene& scene, double t_s);
    // Call after the session. The snapshot's error, or nullopt.
    std::optional<FileError> error() const;

  private:
    const RunOptions& options_;
    const SnapshotAssets& assets_;
    bool taken_ = false;
    std::optional<FileError> error_;
};

// Replaces the scene's initial state by the snapshot of --resume, if given. Players keep their
// persistent ids. Fails if there are climbers and --resume or --snapshot is given, because a
// snapshot does not contain their plans.
std::optional<FileError> resume_from_snapshot(const RunOptions& options,
                                              const RunSettings& settings,
                                              const SnapshotAssets& assets, Scene& scene,
                                              std::vector<PlayerEntities>& players);

}  // namespace handhold
