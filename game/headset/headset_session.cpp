#include "game/headset/headset_session.hpp"

#include <utility>

#include "game/assets/body_clips_asset.hpp"
#include "game/devices/controller_profile.hpp"
#include "game/scene/place_scene.hpp"

namespace handhold {
namespace {

constexpr double k_player_kg = 80.0;
constexpr HapticPulse k_touch_pulse{0.25, 0.015};
constexpr HapticPulse k_grip_pulse{0.8, 0.04};
constexpr double k_touch_radius_m = 0.02;  // radius of a sphere in the palm
constexpr double k_touch_reach_m = 0.03;   // reach beyond the palm's skin

}  // namespace

HeadsetSession::HeadsetSession(Scene scene, const Pose& origin_ws)
    : scene_(std::move(scene)),
      caches_(*scene_.shapes, scene_.grip_meshes.get()),
      player_(add_scene_player(
          scene_, {free_player_name(scene_.world, "player0"), origin_ws, k_player_kg})) {
    caches_.body_clips = game_body_clips();
}

void HeadsetSession::set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip) {
    handhold::set_controller_joints(hand_in_grip, scene_.world);
    joints_ = hand_in_grip;
}

void HeadsetSession::step(TrackingSample sample, PlayerCommands commands, double dt_s) {
    place_scene(scene_, caches_);
    const double start_s = scene_.world.clock.t_s;
    samples_.clear();
    if (scene_.world.clock.frame == 0) {  // a recording begins with its session
        samples_.push_back(sample);
        samples_.back().t_s = start_s;
    }
    sample.t_s = start_s + dt_s;
    samples_.push_back(sample);
    if (records_) {
        for (const TrackingSample& each : samples_) {
            recording_.samples.push_back(recorded(each));
            for (RecordedHand& hand : recording_.samples.back().hands) {
                hand.buttons |= commands.calibrate ? k_button_menu : 0;
            }
        }
    }
    if (scene_.tuning.locomotion.thruster_mps2 == 0.0) {
        commands.thrust_ps.setZero();  // has no effect, but commands are state
    }
    used_sticks_ = used_sticks_ || commands.brake > 0.0 || commands.smooth_turn != 0.0 ||
                   commands.snap_turns != 0 || !commands.thrust_ps.isZero();
    const PlayerInput from{player_.player, samples_, commands};
    step_frame(scene_.world, caches_, scene_.tuning, {dt_s, {&from, 1}}, stats_);
    feel();
}

// True if a sphere cast out of the palm hits something within reach. Colliders have the poses of
// the last frame.
bool HeadsetSession::touches(HandSide side) const {
    const RenderPose::Hand& hand =
        scene_.world.render_pose.at(player_.player).hands[index_of(side)];
    if (!is_valid(hand.tracked_ws)) {
        return false;
    }
    Vec3 palm = scene_.tuning.hand.palm_center_m;
    palm.x() *= side == HandSide::right ? 1.0 : -1.0;
    const std::uint64_t himself = scene_.world.persistent_id.at(player_.player).value;
    const Vec3 above = palm + k_touch_radius_m * Vec3::UnitY();
    const Vec3 below = palm - (k_touch_reach_m - k_touch_radius_m) * Vec3::UnitY();
    return caches_.collision
        .cast_sphere(k_touch_radius_m, transform_point(hand.tracked_ws, above),
                     transform_point(hand.tracked_ws, below), {&himself, 1})
        .has_value();
}

void HeadsetSession::feel() {
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const bool grips = scene_.world.grab.at(player_.hands[i]).kind != GripKind::none;
        const bool touch = touches(static_cast<HandSide>(i));
        pulses_[i] = grips && !gripped_[i]             ? k_grip_pulse
                     : touch && !grips && !touched_[i] ? k_touch_pulse
                                                       : HapticPulse{};
        gripped_[i] = grips;
        touched_[i] = touch || grips;
    }
}

}  // namespace handhold
