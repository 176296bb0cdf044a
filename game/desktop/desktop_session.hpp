#pragma once

#include "game/desktop/desktop_body.hpp"
#include "game/session/recording.hpp"
#include "systems/frame.hpp"
#include "systems/snapshot.hpp"

namespace handhold {

// All that the next frames of a session depend on, but for its scene and tuning.
struct DesktopState {
    std::vector<std::byte> world;  // a snapshot
    DesktopBody body;
    std::size_t recorded = 0;  // samples
    bool used_sticks = false;
};

// A scene that one person plays from a desk, frame by frame.
class DesktopSession {
  public:
    DesktopSession(Scene scene, const Pose& origin_ws);

    static constexpr double k_dt_s = 1.0 / 90.0;
    // One frame.
    void step(const DesktopInput& input);

    // Between frames. A state is restored to the session that it came from, or to one of the same
    // scene and place: it goes on bit for bit.
    DesktopState save(const SnapshotAssets& assets) const;
    void restore(const DesktopState& state, const SnapshotAssets& assets);

    // Of controllers that are another make than Tuning's. Between frames.
    void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip);

    const Scene& scene() const { return scene_; }
    Tuning& tuning() { return scene_.tuning; }  // between frames; a recording does not keep it
    const FrameCaches& caches() const { return caches_; }
    const StageStats& stats() const { return stats_; }  // of the last frame
    const PlayerEntities& player() const { return player_; }
    const DesktopBody& body() const { return body_; }
    // Keeps what the headset says from the first frame on. Played from the same place at 90 Hz it
    // repeats every bit, but for turns, brake and jets, which recordings have no place for.
    void record() { records_ = true; }
    const Recording& recording() const { return recording_; }
    bool used_sticks() const { return used_sticks_; }

  private:
    Scene scene_;
    FrameCaches caches_;
    PlayerEntities player_;
    DesktopBody body_;
    std::vector<TrackingSample> samples_;  // reused
    Recording recording_;
    bool records_ = false;
    bool used_sticks_ = false;
    StageStats stats_;
};

}  // namespace handhold
