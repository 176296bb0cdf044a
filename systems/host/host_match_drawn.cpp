// Poses to draw between two ticks of a match.
#include "systems/host/host_match.hpp"
#include "systems/host/host_match_packets.hpp"
#include "systems/host/host_samples.hpp"

namespace handhold {
namespace {

const hh_match& drawing_match(const hh_match* match) {
    const hh_match& of_host = match_of(match);
    require(of_host.client != nullptr || of_host.spectator != nullptr, HH_ERROR_STATE,
            "the match is neither a client's nor a spectator's");
    return of_host;
}

const MatchWorld& drawn_world(const hh_match& match) {
    return match.client != nullptr ? match.client->match() : match.spectator->match();
}

// The time of the picture, before that of the last tick.
double before_ticks(const hh_match& match) {
    return 1.0 -
           (match.client != nullptr ? match.client->past_ticks() : match.spectator->past_ticks());
}

// Head and empty hands where the devices are now.
void follow_devices(const hh_world& host, Entity player, const TrackingSample& newest,
                    const Pose& samples_space_ws, DrawnPlayer& drawn) {
    if (is_valid(newest.head_ps)) {
        drawn.head_ws = samples_space_ws * newest.head_ps;
    }
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        DrawnPlayer::Hand& hand = drawn.hands[index_of(side)];
        const Pose& controller_ps = newest.controllers[index_of(side)].controller_ps;
        if (!hand.is_holding && is_valid(controller_ps)) {
            hand.shown_ws = samples_space_ws * controller_ps *
                            hand_in_controller(host, player, side) * hand.shown_in_tracked;
        }
    }
}

}  // namespace

void note_drawn(hh_match& match) {
    match.drawn.note(drawn_world(match),
                     match.client != nullptr ? match.client->shown_offsets() : PointsOfAll{});
}

}  // namespace handhold

using namespace handhold;

hh_result hh_match_drawn_player(const hh_match* match, uint32_t slot,
                                const hh_tracking_sample* newest, hh_pose* origin, hh_pose* head,
                                hh_pose* left, hh_pose* right) {
    return call([&] {
        const hh_match& of_host = drawing_match(match);
        require(origin != nullptr && head != nullptr && left != nullptr && right != nullptr,
                HH_ERROR_NULL, "an output is null");
        const std::size_t wanted = slot_of(of_host, slot);
        require(newest == nullptr || (of_host.client != nullptr && slot == of_host.def.slot),
                HH_ERROR_VALUE, "newest samples are for the own slot");
        require(!of_host.drawn.is_empty(), HH_ERROR_STATE, "no tick was shown yet");
        const hh_world& host = of_host.host;
        const Entity player = find_by_id(host.world, drawn_world(of_host).players[wanted]);
        DrawnPlayer drawn = of_host.drawn.player(wanted, before_ticks(of_host));
        const Pose samples_ws = drawn.origin_ws * samples_in_play_space(host, player);
        if (newest != nullptr) {
            follow_devices(host, player, exact_sample(newest, 0), samples_ws, drawn);
        }
        *origin = to_c(samples_ws);
        *head = to_c(drawn.head_ws);
        *left = to_c(drawn.hands[index_of(HandSide::left)].shown_ws);
        *right = to_c(drawn.hands[index_of(HandSide::right)].shown_ws);
    });
}

hh_result hh_match_drawn_bodies(const hh_match* match, const hh_body* bodies, size_t count,
                                hh_pose* poses) {
    return call([&] {
        const hh_match& of_host = drawing_match(match);
        require(count == 0 || (bodies != nullptr && poses != nullptr), HH_ERROR_NULL,
                "the ids or the buffer are null");
        require(!of_host.drawn.is_empty(), HH_ERROR_STATE, "no tick was shown yet");
        const hh_world& host = of_host.host;
        for (std::size_t i = 0; i < count; ++i) {
            body_of(host, bodies[i]);
        }
        const double before = before_ticks(of_host);
        for (std::size_t i = 0; i < count; ++i) {
            const Entity body = entity_of(bodies[i]);
            const Pose& now_ws = host.world.body_pose.at(body).pose_ws;
            poses[i] = to_c(
                host_pose_of(host, body, of_host.drawn.body(host.world, body, now_ws, before)));
        }
    });
}
