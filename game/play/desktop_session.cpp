#include "game/play/desktop_session.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/devices/controller_profile.hpp"
#include "game/scene/place_scene.hpp"

namespace handhold {
DesktopSession::DesktopSession(Scene scene, const Pose& origin_ws)
    : scene_(std::move(scene)),
      caches_(*scene_.shapes, scene_.grip_meshes.get()),
      player_(
          add_scene_player(scene_, {free_player_name(scene_.world, "player0"), origin_ws, 80.0})) {
    caches_.body_clips = game_body_clips();
}

void DesktopSession::set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip) {
    handhold::set_controller_joints(hand_in_grip, scene_.world);
}

void DesktopSession::step(const DesktopInput& input) {
    place_scene(scene_, caches_);
    const double start_s = scene_.world.clock.t_s;
    samples_.clear();
    if (scene_.world.clock.frame == 0) {  // a recording starts with a sample at the session's start
        samples_.push_back(body_.advance(scene_, caches_.collision, player_, {}, start_s, 1e-9));
    }
    samples_.push_back(
        body_.advance(scene_, caches_.collision, player_, input, start_s + k_dt_s, k_dt_s));
    if (records_) {
        for (const TrackingSample& sample : samples_) {
            recording_.samples.push_back(recorded(sample));
        }
    }
    PlayerCommands commands = body_.commands(input);
    if (scene_.tuning.locomotion.thruster_mps2 == 0.0) {
        // Jets are off, but commands are state and must be equal in every replay.
        commands.thrust_ps.setZero();
    }
    used_sticks_ = used_sticks_ || input.brake || input.smooth_turn != 0.0 ||
                   input.snap_turns != 0 || !commands.thrust_ps.isZero();
    const PlayerInput from{player_.player, samples_, commands};
    step_frame(scene_.world, caches_, scene_.tuning, {k_dt_s, {&from, 1}}, stats_);
}

DesktopState DesktopSession::save(const SnapshotAssets& assets) const {
    DesktopState state{{}, body_, recording_.samples.size(), used_sticks_};
    save_snapshot(scene_.world, assets, state.world);
    return state;
}

void DesktopSession::restore(const DesktopState& state, const SnapshotAssets& assets) {
    const auto error = restore_snapshot(state.world, assets, scene_.world);
    HH_CHECK(!error, "the state belongs to another session", state.world.size());
    body_ = state.body;
    recording_.samples.resize(std::min(recording_.samples.size(), state.recorded));
    used_sticks_ = state.used_sticks;
}

}  // namespace handhold
