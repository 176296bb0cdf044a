// Events of the C interface: the differences between two steps (handhold/players.h).
#include "systems/host/host_events.hpp"

#include <array>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "systems/host/host_impulses.hpp"

namespace handhold {
namespace {

// Distance of the palm from a surface for HH_EVENT_TOUCHED; times the player's scale.
constexpr double k_event_touch_m = 0.02;

HandReport& report_of(hh_world& host, Entity hand) {
    HandReport* const known = host.hands.find(hand);
    return known != nullptr ? *known : host.hands.add(hand);
}

struct Gripped {
    Entity entity;  // a body or a player, which may be removed by now
    bool is_player = false;
};

Gripped as_gripped(const hh_world& host, Entity entity) {
    return {entity, host.world.player.contains(entity)};
}

Pose tracked_hand_ws(const hh_world& host, Entity hand) {
    const World& world = host.world;
    return world.player_origin.at(world.hand_owner.at(hand).player).pose_ws *
           world.hand_tracking.at(hand).pose_ps;
}

hh_event hand_event(const hh_world& host, hh_event_kind kind, hh_reason reason, Entity hand,
                    const Gripped& what) {
    const HandOwner& owner = host.world.hand_owner.at(hand);
    hh_event event{};
    event.kind = kind;
    event.reason = reason;
    event.player = id_of<hh_player>(owner.player);
    event.side = owner.side == HandSide::left ? HH_LEFT : HH_RIGHT;
    if (what.is_player) {
        event.other = id_of<hh_player>(what.entity);
    } else {
        event.body = id_of<hh_body>(what.entity);
    }
    const RenderPose& shown = host.world.render_pose.at(owner.player);
    event.position = to_c(host.shows_hands ? shown.hands[index_of(owner.side)].shown_ws.position
                                           : tracked_hand_ws(host, hand).position);
    return event;
}

const HandNote* note_of(const hh_world& host, Entity hand) {
    for (const HandNote& note : host.stats.hand_notes) {
        if (note.hand == hand) {
            return &note;
        }
    }
    return nullptr;
}

hh_reason reason_of(Fallback fallback) {
    switch (fallback) {
        case Fallback::grab_no_surface:
        case Fallback::grab_out_of_sight:
            return HH_REASON_NO_SURFACE;
        case Fallback::grab_refused_by_rule:
            return HH_REASON_NOT_ALLOWED;
        case Fallback::grab_needs_two_hands:
        case Fallback::grip_needs_two_hands:
            return HH_REASON_NEEDS_TWO_HANDS;
        case Fallback::grip_stretched:
            return HH_REASON_STRETCHED;
        case Fallback::grip_out_of_reach:
            return HH_REASON_TRACKING_LOST;
        case Fallback::grip_body_gone:
            return HH_REASON_BODY_GONE;
        case Fallback::grip_ended_by_host:
            return HH_REASON_BY_HOST;
        default:
            return HH_REASON_NONE;
    }
}

bool is_slip(hh_reason reason) {
    return reason == HH_REASON_STRETCHED || reason == HH_REASON_BODY_GONE ||
           reason == HH_REASON_TRACKING_LOST || reason == HH_REASON_NEEDS_TWO_HANDS;
}

hh_reason why_let_go(const hh_world& host, Entity hand) {
    const HandNote* const note = note_of(host, hand);
    const hh_reason noted = note != nullptr ? reason_of(note->reason) : HH_REASON_NONE;
    const HandTracking& tracking = host.world.hand_tracking.at(hand);
    if (noted != HH_REASON_NONE && noted != HH_REASON_NO_SURFACE &&
        noted != HH_REASON_NOT_ALLOWED) {
        return noted;
    }
    if (tracking.resumed) {
        return HH_REASON_TRACKING_LOST;
    }
    return tracking.edge == GrabEdge::release ? HH_REASON_OPENED : HH_REASON_OTHER_HAND;
}

void add_grip_events(hh_world& host) {
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Entity hand = host.world.grab.owners()[index];
        const Grab& grab = host.world.grab.elements()[index];
        HandReport& before = report_of(host, hand);
        const bool is_other = grab.body != before.body || grab.since_s != before.since_s;
        if (before.grip != GripKind::none && (grab.kind == GripKind::none || is_other)) {
            const hh_reason reason = why_let_go(host, hand);
            host.events.push_back(hand_event(host,
                                             is_slip(reason) ? HH_EVENT_SLIPPED : HH_EVENT_RELEASED,
                                             reason, hand, {before.body, before.is_player}));
        }
        if (grab.kind != GripKind::none && (before.grip == GripKind::none || is_other)) {
            host.events.push_back(hand_event(host, HH_EVENT_GRABBED, HH_REASON_NONE, hand,
                                             as_gripped(host, grab.body)));
        }
        before.grip = grab.kind;
        before.body = grab.body;
        before.is_player = host.world.player.contains(grab.body);
        before.since_s = grab.since_s;
    }
    for (const HandNote& note : host.stats.hand_notes) {
        const bool is_refusal = note.reason == Fallback::grab_no_surface ||
                                note.reason == Fallback::grab_out_of_sight ||
                                note.reason == Fallback::grab_refused_by_rule ||
                                note.reason == Fallback::grab_needs_two_hands;
        if (is_refusal && host.world.grab.at(note.hand).kind == GripKind::none) {
            host.events.push_back(hand_event(host, HH_EVENT_REFUSED, reason_of(note.reason),
                                             note.hand, as_gripped(host, note.body)));
        }
    }
}

void measure_impulses(hh_world& host) {
    for (HandReport& report : host.hands.elements()) {
        report.impulse_ns.setZero();
    }
    const std::vector<RowBlock>& blocks = host.caches.graph.graph.blocks;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (is_drive(blocks[i]) && blocks[i].source < host.world.grab.size()) {
            report_of(host, host.world.grab.owners()[blocks[i].source]).impulse_ns -=
                reported_impulse_ns(host, i);
        }
    }
}

void add_touch_events(hh_world& host) {
    TuningOfPlayers tunings(host.tuning);
    for (std::size_t index = 0; index < host.world.hand_owner.size(); ++index) {
        const Entity hand = host.world.hand_owner.owners()[index];
        const HandOwner& owner = host.world.hand_owner.elements()[index];
        HandReport& report = report_of(host, hand);
        Entity touched = k_no_entity;
        if (report.grip == GripKind::none &&
            host.world.hand_tracking.at(hand).state == TrackingState::tracked) {
            const Pose hand_ws = tracked_hand_ws(host, hand);
            const PlayerOrigin& origin = host.world.player_origin.at(owner.player);
            const PalmRay ray = palm_ray(hand_ws, owner.side, tunings.of(origin).hand);
            const std::array own_head = {host.world.persistent_id.at(owner.player).value};
            const SurfaceQuery surfaces = host.caches.host_surfaces
                                              ? host.caches.host_surfaces
                                              : SurfaceQuery(host.caches.collision);
            const auto found =
                surfaces.closest_point(ray.palm_ws, origin.scale * k_event_touch_m, own_head);
            touched = found ? find_by_id(host.world, {found->id}) : k_no_entity;
        }
        if (!is_null(touched) && touched != report.touched) {
            host.events.push_back(hand_event(host, HH_EVENT_TOUCHED, HH_REASON_NONE, hand,
                                             as_gripped(host, touched)));
        }
        report.touched = touched;
    }
}

template <typename T, typename Required>
void drop_stale(Column<T>& column, const Column<Required>& required) {
    for (std::size_t index = column.size(); index-- > 0;) {
        if (!required.contains(column.owners()[index])) {
            column.remove(column.owners()[index]);
        }
    }
}

}  // namespace

void begin_events(hh_world& host) {
    host.events.clear();
    // Adds events for grips that ended between the steps, by teleports or hh_hand_hold.
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Entity hand = host.world.grab.owners()[index];
        HandReport& report = report_of(host, hand);
        if (report.grip != GripKind::none &&
            host.world.grab.elements()[index].kind == GripKind::none) {
            host.events.push_back(hand_event(host, HH_EVENT_RELEASED, HH_REASON_BY_HOST, hand,
                                             {report.body, report.is_player}));
            report.grip = GripKind::none;
        }
    }
}

void finish_events(hh_world& host) {
    add_grip_events(host);
    limit_impulses(host);
    measure_impulses(host);
    gather_contacts(host);
    add_contact_events(host, HH_EVENT_CONTACT_BEGAN, host.contacts, host.last_contacts);
    add_contact_events(host, HH_EVENT_CONTACT_ENDED, host.last_contacts, host.contacts);
    update_joint_reports(host, true);
    report_recentrings(host, true);
    if (host.settings.reports_touches) {
        add_touch_events(host);
    }
}

void forget_events(hh_world& host) {
    host.events.clear();
    host.contacts.clear();
    host.contact_list.clear();
    host.last_contacts.clear();
    drop_stale(host.hands, host.world.grab);
    drop_stale(host.joints, host.world.joint);
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Grab& grab = host.world.grab.elements()[index];
        report_of(host, host.world.grab.owners()[index]) = {
            .grip = grab.kind,
            .body = grab.body,
            .is_player = host.world.player.contains(grab.body),
            .since_s = grab.since_s};
    }
    update_joint_reports(host, false);
    drop_stale(host.spaces, host.world.player);
    report_recentrings(host, false);
}

}  // namespace handhold

hh_result hh_world_events_sized(const hh_world* world, const hh_event** events, size_t* count,
                                size_t event_size) {
    using namespace handhold;
    return call([&] {
        const hh_world& host = world_of(world);
        require(events != nullptr && count != nullptr, HH_ERROR_NULL, "an output is null");
        // Its first version is that of 0.2.0.
        require_size<hh_event>(event_size);
        *events = host.events.data();
        *count = host.events.size();
        if (event_size < sizeof(hh_event)) {
            host.packed_events.resize(host.events.size() * event_size);
            hh_event* const packed = reinterpret_cast<hh_event*>(host.packed_events.data());
            for (std::size_t i = 0; i < host.events.size(); ++i) {
                std::memcpy(&sized_element(packed, event_size, i), &host.events[i], event_size);
            }
            *events = packed;
        }
    });
}
