#pragma once

#include <cstddef>
#include <vector>

#include <handhold/handhold.hpp>

#include "game/devices/desktop_body.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// A session's complete state, except its scene and tuning.
struct DesktopState {
    std::vector<std::byte> world;  // a snapshot
    DesktopBody body;
    std::size_t recorded = 0;  // number of samples recorded so far
    bool used_sticks = false;
};

// A scene that one person plays at a desktop, frame by frame.
class DesktopSession {
  public:
    DesktopSession(Scene scene, const hh::Pose& origin_ws);
    // In a match: the scene has its players and clips already, and the match steps its world.
    DesktopSession(Scene scene, hh::Player player);

    // See DesktopBody. Call before the first frame.
    void face_nearest_surface() { body_.face_nearest_surface(scene_.host, player_); }

    static constexpr double k_dt_s = 1.0 / 90.0;
    // Advances one frame.
    void step(const DesktopInput& input);

    // What the devices of this desktop say at the end of a frame: appends a sample, and returns the
    // commands. `step` does it by itself; for worlds that a match steps.
    hh_commands advance_devices(const DesktopInput& input, double end_s,
                                std::vector<hh::Sample>& samples);
    // What the devices say `dt_s` after the last frame, for a picture between two frames.
    hh::Sample devices_in(const DesktopInput& input, double dt_s);
    // The desktop's player is this one from now on.
    void play_as(hh::Player player) { player_ = player; }

    // Call save() and restore() between frames. A state can be restored to the session that
    // saved it, or to one with the same scene and start pose. The session then continues bit
    // for bit.
    DesktopState save();
    void restore(const DesktopState& state);

    // Sets the poses of the hands in their controllers' grip frames, by hh::Side, instead of
    // Tuning's. Call between frames.
    void set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip);

    const Scene& scene() const { return scene_; }
    // Gives access to the tuning, which may be changed between frames. Recordings do not contain
    // such changes.
    Scene& scene() { return scene_; }
    const hh::World& world() const { return scene_.host; }
    hh::World& world() { return scene_.host; }
    hh::Player player() const { return player_; }
    const DesktopBody& body() const { return body_; }
    // Records tracking; call before the first frame. A replay from the same place at 90 Hz repeats
    // every bit, unless the player used turns, brake or jets: recordings do not contain them.
    void record() { records_ = true; }
    const Recording& recording() const { return recording_; }
    bool used_sticks() const { return used_sticks_; }

  private:
    void record_sample(const hh::Sample& sample);

    Scene scene_;
    hh::Player player_;
    DesktopBody body_;
    std::vector<hh::Sample> samples_;  // reused memory
    Recording recording_;
    bool records_ = false;
    bool used_sticks_ = false;
};

}  // namespace handhold
