#include "game/headset/headset_session.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include <handhold/math.hpp>

#include "game/assets/body_clips_asset.hpp"
#include "game/devices/controller_profile.hpp"

namespace handhold {
namespace {

constexpr HapticPulse k_touch_pulse{0.25, 0.015};
constexpr HapticPulse k_grip_pulse{0.8, 0.04};
constexpr double k_touch_radius_m = 0.02;  // radius of the sphere that is cast out of the palm
// A surface up to this far in front of the palm's skin counts as touched.
constexpr double k_touch_reach_m = 0.03;

}  // namespace

HeadsetSession::HeadsetSession(Scene scene, const hh::Pose& origin_ws)
    : scene_(std::move(scene)), player_(add_scene_player(scene_, "player0", origin_ws)) {
    load_game_body_clips(scene_.host);
}

void HeadsetSession::set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip) {
    handhold::set_controller_joints(hand_in_grip, scene_.host);
    joints_ = hand_in_grip;
}

void HeadsetSession::step(hh::Sample sample, hh_commands commands, double dt_s) {
    hh::World& world = scene_.host;
    const double start_s = world.time_s();
    samples_.clear();
    if (world.frame() == 0) {  // a recording begins with its session
        samples_.push_back(sample);
        samples_.back().time_s = start_s;
    }
    sample.time_s = start_s + dt_s;
    samples_.push_back(sample);
    if (records_) {
        for (const hh::Sample& each : samples_) {
            recording_.samples.push_back(recorded(each));
            for (RecordedHand& hand : recording_.samples.back().hands) {
                hand.buttons |= commands.calibrate ? k_button_menu : 0;
            }
        }
    }
    if (*world.tuning("locomotion.thruster_mps2") == 0.0) {
        commands.thrust = {};  // the thrust has no effect, but commands are part of the state
    }
    used_sticks_ = used_sticks_ || commands.brake > 0.0 || commands.smooth_turn != 0.0 ||
                   commands.snap_turns != 0 || !(commands.thrust == hh::Vec3{});
    if (const hh::Status stepped = world.step(dt_s, hh::input(player_, samples_, commands));
        !stepped) {
        throw std::logic_error(std::string(stepped.text()));
    }
    if (scene_.arena) {
        scene_.arena->step(world, world.frame());
    }
    feel();
}

// True if a sphere cast out of the palm hits something within reach.
bool HeadsetSession::touches(hh::Side side) {
    const hh::Pose hand_ws = scene_.host.hand(player_, side)->tracked;
    if (!hh::is_valid(hand_ws)) {
        return false;
    }
    hh::Vec3 palm = *scene_.host.tuning_vector("hand.palm_center_m");
    palm.x *= side == HH_RIGHT ? 1.0 : -1.0;
    const hh::Vec3 above = palm + k_touch_radius_m * hh::k_y;
    const hh::Vec3 below = palm - (k_touch_reach_m - k_touch_radius_m) * hh::k_y;
    return scene_.host
        .cast_sphere(k_touch_radius_m, hh::transform_point(hand_ws, above),
                     hh::transform_point(hand_ws, below), player_)
        .has_value();
}

void HeadsetSession::feel() {
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const bool grips = scene_.host.hand(player_, side)->grip != HH_GRIP_NONE;
        const bool touch = touches(side);
        pulses_[side] = grips && !gripped_[side]             ? k_grip_pulse
                        : touch && !grips && !touched_[side] ? k_touch_pulse
                                                             : HapticPulse{};
        gripped_[side] = grips;
        touched_[side] = touch || grips;
    }
}

}  // namespace handhold
