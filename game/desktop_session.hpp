#pragma once

#include "game/desktop_body.hpp"
#include "game/recording.hpp"
#include "systems/frame.hpp"

namespace handhold {

// A scene that one person plays from a desk, frame by frame.
class DesktopSession {
  public:
    DesktopSession(Scene scene, const Pose& origin_ws);

    static constexpr double k_dt_s = 1.0 / 90.0;
    // One frame.
    void step(const DesktopInput& input);

    const Scene& scene() const { return scene_; }
    const PlayerEntities& player() const { return player_; }
    const DesktopBody& body() const { return body_; }
    // Keeps what the headset says from the first frame on. Played from the same place at 90 Hz it
    // repeats every bit, but for brake and jets, which recordings have no place for.
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
};

}  // namespace handhold
