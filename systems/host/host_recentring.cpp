// Recentrings of devices in the C interface (handhold/players.h). Hosts call the space of the
// samples the player's origin. A recentring moves that space in play space.
#include "systems/host/host_world.hpp"

namespace handhold {
namespace {

// Returns the pose without a tilt as small as rounding leaves. Refuses larger tilts.
Pose level(const Pose& pose) {
    constexpr double k_max_tilt = 1e-3;
    const Quat& turn = pose.rotation;
    require(std::abs(turn.x()) <= k_max_tilt && std::abs(turn.z()) <= k_max_tilt, HH_ERROR_VALUE,
            "a recentring turns about +Y only");
    return {pose.position, Quat(turn.w(), 0.0, turn.y(), 0.0).normalized()};
}

// True if samples differ from play space. Else poses are not multiplied, so that they stay equal to
// the bit.
bool is_corrected(const hh_world& host, Entity player) {
    const HeadTracking& head = host.world.head_tracking.at(player);
    return head.shift_m != Vec3::Zero() || head.shift_turn.coeffs() != Quat::Identity().coeffs();
}

void set_guess(hh_world& host, Entity player, bool guesses) {
    host.world.recenter_guess.remove(player);
    if (!guesses) {
        host.world.recenter_guess.add(player, {false});
    }
}

}  // namespace

Pose samples_in_play_space(const hh_world& host, Entity player) {
    const HeadTracking& head = host.world.head_tracking.at(player);
    return {head.shift_m, head.shift_turn};
}

Pose samples_space_ws(const hh_world& host, Entity player) {
    const Pose& play_space = host.world.player_origin.at(player).pose_ws;
    return is_corrected(host, player) ? play_space * samples_in_play_space(host, player)
                                      : play_space;
}

Pose play_space_ws(const hh_world& host, Entity player, const Pose& samples_space_ws) {
    return is_corrected(host, player)
               ? samples_space_ws * inverse(samples_in_play_space(host, player))
               : samples_space_ws;
}

void report_recentrings(hh_world& host, bool makes_events) {
    for (const Entity player : host.world.player.owners()) {
        const Pose correction = samples_in_play_space(host, player);
        SpaceReport* report = host.spaces.find(player);
        if (report == nullptr) {
            report = &host.spaces.add(player);
        }
        const bool is_changed =
            correction.position != report->correction.position ||
            correction.rotation.coeffs() != report->correction.rotation.coeffs();
        if (makes_events && is_changed) {
            hh_event event{};
            event.kind = HH_EVENT_RECENTRED;
            event.reason = report->is_announced ? HH_REASON_BY_HOST : HH_REASON_NONE;
            event.player = id_of<hh_player>(player);
            event.side = -1;
            event.position =
                to_c(transform_point(host.world.player_origin.at(player).pose_ws,
                                     host.world.head_tracking.at(player).pose_ps.position));
            host.events.push_back(event);
        }
        *report = {correction, false};
    }
}

}  // namespace handhold

using namespace handhold;

hh_result hh_player_recenter(hh_world* world, hh_player player, hh_pose new_in_old) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity entity = player_of(host, player);
        const Pose space = level(checked(new_in_old));
        HeadTracking& head = host.world.head_tracking.at(entity);
        set_guess(host, entity, false);
        if (head.state == TrackingState::never) {
            return;  // no sample was given in the old space
        }
        head.shift_m = head.shift_turn * space.position + head.shift_m;
        head.shift_turn = (head.shift_turn * space.rotation).normalized();
        if (EarlySamples* const early = host.world.early_samples.find(entity)) {
            const Pose old_in_new = inverse(space);
            for (EarlySample& sample : std::span{early->samples}.first(early->count)) {
                sample.head_ps = old_in_new * sample.head_ps;
                for (Pose& controller_ps : sample.controllers_ps) {
                    controller_ps = old_in_new * controller_ps;
                }
            }
        }
        if (SpaceReport* const report = host.spaces.find(entity)) {
            report->is_announced = true;
        }
    });
}

hh_result hh_player_set_recenter_guess(hh_world* world, hh_player player, uint8_t guesses) {
    return call([&] {
        hh_world& host = world_of(world);
        set_guess(host, player_of(host, player), guesses != 0);
    });
}
