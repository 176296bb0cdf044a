#include "game/play/desktop_session.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "game/assets/body_clips_asset.hpp"
#include "game/devices/controller_profile.hpp"

namespace handhold {
namespace {

// Throws if a call of the library failed. Calls of a session fail only because of a defect.
void expect_done(const hh::Status& status) {
    if (!status) {
        throw std::logic_error(std::string(status.text()));
    }
}

}  // namespace

DesktopSession::DesktopSession(Scene scene, const hh::Pose& origin_ws)
    : scene_(std::move(scene)), player_(add_scene_player(scene_, "player0", origin_ws)) {
    load_game_body_clips(scene_.host);
}

DesktopSession::DesktopSession(Scene scene, hh::Player player)
    : scene_(std::move(scene)), player_(player) {}

void DesktopSession::set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip) {
    handhold::set_controller_joints(hand_in_grip, scene_.host);
}

void DesktopSession::step(const DesktopInput& input) {
    hh::World& world = scene_.host;
    const double start_s = world.time_s();
    samples_.clear();
    if (world.frame() == 0) {  // a recording starts with a sample at the session's start
        samples_.push_back(body_.advance(world, player_, {}, start_s, 1e-9));
        record_sample(samples_.back());
    }
    hh_commands commands = advance_devices(input, start_s + k_dt_s, samples_);
    if (*world.tuning("locomotion.thruster_mps2") == 0.0) {
        // Jets are off, but commands are state and must be equal in every replay.
        commands.thrust = {};
    }
    used_sticks_ = used_sticks_ || input.brake || input.smooth_turn != 0.0 ||
                   input.snap_turns != 0 || !(commands.thrust == hh::Vec3{});
    expect_done(world.step(k_dt_s, hh::input(player_, samples_, commands)));
    if (scene_.arena) {
        scene_.arena->step(world, world.frame());
    }
}

hh_commands DesktopSession::advance_devices(const DesktopInput& input, double end_s,
                                            std::vector<hh::Sample>& samples) {
    samples.push_back(body_.advance(scene_.host, player_, input, end_s, k_dt_s));
    record_sample(samples.back());
    return body_.commands(input);
}

hh::Sample DesktopSession::devices_in(const DesktopInput& input, double dt_s) {
    constexpr double k_least_s = 1e-6;
    DesktopBody body = body_;
    const double step_s = std::clamp(dt_s, k_least_s, k_dt_s);
    return body.advance(scene_.host, player_, input, scene_.host.time_s() + step_s, step_s);
}

// A state of a match may set the world's clock back, but a recording's times increase.
void DesktopSession::record_sample(const hh::Sample& sample) {
    if (records_ && (recording_.samples.empty() || sample.time_s > recording_.samples.back().t_s)) {
        recording_.samples.push_back(recorded(sample));
    }
}

DesktopState DesktopSession::save() {
    DesktopState state{{}, body_, recording_.samples.size(), used_sticks_};
    expect_done(scene_.host.save(state.world));
    return state;
}

void DesktopSession::restore(const DesktopState& state) {
    if (!scene_.host.restore(state.world)) {
        throw std::invalid_argument("the state belongs to another session");
    }
    if (scene_.arena) {
        scene_.arena->read_boards(scene_.host);
    }
    body_ = state.body;
    recording_.samples.resize(std::min(recording_.samples.size(), state.recorded));
    used_sticks_ = state.used_sticks;
}

}  // namespace handhold
