#include "systems/locomotion/update_grabs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "components/hand_rows.hpp"
#include "components/play_space.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

struct Surface {
    Entity body;
    Vec3 point_ws;
    Vec3 normal_ws;
};

Entity owner_of_id(const UpdateGrabsIo& io, std::uint64_t id) {
    for (const std::span<const Entity> owners : {io.body.owners(), io.origin.owners()}) {
        for (const Entity entity : owners) {
            if (io.persistent_id.at(entity).value == id) {
                return entity;
            }
        }
    }
    return k_no_entity;
}

template <typename T>
const T* find_in(const Column<T>* column, Entity entity) {
    return column != nullptr ? column->find(entity) : nullptr;
}

bool may_grip(const UpdateGrabsIo& io, const HandOwner& owner, Entity gripped) {
    const GrabRule* const rule = find_in(io.rule, gripped);
    if (rule != nullptr && !(owner.side == HandSide::left ? rule->left : rule->right)) {
        return false;
    }
    const GrabLayers* const wanted = find_in(io.layers, owner.player);
    if (wanted == nullptr) {
        return true;
    }
    const CollisionFilter* const filter = find_in(io.filter, gripped);
    return (wanted->layers & (filter != nullptr ? *filter : CollisionFilter{}).layers) != 0;
}

bool any_priority(const UpdateGrabsIo& io) {
    return io.rule != nullptr && std::ranges::any_of(io.rule->rows(), [](const GrabRule& rule) {
               return rule.priority != 0;
           });
}

// Looks along the palm's ray and then around the palm, and passes over what refuses the hand.
// Anybody's head may be gripped but one's own.
class SurfaceFinder {
  public:
    SurfaceFinder(const UpdateGrabsIo& io, const HandOwner& owner)
        : io_(io), owner_(owner), looks_on_(any_priority(io)) {
        skip_[0] = io.persistent_id.at(owner.player).value;
    }

    // nullopt: nothing in reach, or only what refuses the hand: see refused_by.
    std::optional<Surface> find(const PalmRay& ray, const HandTuning& tuning) {
        while (offer(io_.collision.cast_ray(ray.from_ws, ray.to_ws, skipped()))) {
        }
        while (!is_done() &&
               offer(io_.collision.closest_point(ray.palm_ws, tuning.reach_m, skipped()))) {
        }
        return best_;
    }
    Entity refused_by() const { return refused_by_; }

  private:
    static constexpr std::size_t k_max_skipped = 16;

    std::span<const std::uint64_t> skipped() const { return {skip_.data(), skip_count_}; }
    bool is_done() const { return best_.has_value() && !looks_on_; }

    // False: there is no sense in looking farther.
    template <typename Found>
    bool offer(const Found& found) {
        if (!found) {
            return false;
        }
        const Entity body = owner_of_id(io_, found->id);
        if (is_null(body)) {
            return false;
        }
        if (!may_grip(io_, owner_, body)) {
            refused_by_ = body;
        } else {
            const GrabRule* const rule = find_in(io_.rule, body);
            const std::int32_t priority = rule != nullptr ? rule->priority : 0;
            if (!best_ || priority > priority_) {
                best_ = Surface{body, found->point_ws, found->normal_ws};
                priority_ = priority;
            }
        }
        if (is_done() || skip_count_ == k_max_skipped) {
            return false;
        }
        skip_[skip_count_++] = found->id;
        return true;
    }

    const UpdateGrabsIo& io_;
    const HandOwner& owner_;
    bool looks_on_;  // past the first surface, for one of higher priority
    std::array<std::uint64_t, k_max_skipped> skip_{};
    std::size_t skip_count_ = 1;
    std::optional<Surface> best_;
    std::int32_t priority_ = 0;
    Entity refused_by_ = k_no_entity;
};

// A grip that a hand may snap to.
struct Snap {
    AuthoredHold hold;
    Surface surface;  // the palm in the grip
    std::int32_t priority = 0;
    double sync_m = 0.0;
    std::uint64_t body_id = 0;

    bool is_before(const Snap& other) const {
        if (priority != other.priority) {
            return priority > other.priority;
        }
        if (sync_m != other.sync_m) {
            return sync_m < other.sync_m;
        }
        return body_id != other.body_id ? body_id < other.body_id : hold.grip < other.hold.grip;
    }
};

// A hand that holds on by a grip has it for itself.
bool is_taken(const UpdateGrabsIo& io, Entity own_hand, Entity body, std::uint8_t grip) {
    for (std::size_t row = 0; row < io.authored_hold.size(); ++row) {
        const Entity hand = io.authored_hold.owners()[row];
        const AuthoredHold& hold = io.authored_hold.rows()[row];
        const Grab& grab = io.grab.at(hand);
        if (hand != own_hand && hold.body == body && hold.grip == grip && grab.body == body &&
            grab.kind != GripKind::none && grab.phase != GrabPhase::releasing) {
            return true;
        }
    }
    return false;
}

// Something else between the palm and where the grip has it.
bool is_blocked(const UpdateGrabsIo& io, Entity player, const Vec3& from_ws, const Vec3& to_ws,
                std::uint64_t body_id) {
    constexpr double k_there_m = 1e-6;
    if ((to_ws - from_ws).norm() < k_there_m) {
        return false;
    }
    const std::array own_head = {io.persistent_id.at(player).value};
    const auto hit = io.collision.cast_ray(from_ws, to_ws, own_head);
    return hit && hit->id != body_id;
}

class SnapFinder {
  public:
    SnapFinder(const UpdateGrabsIo& io, Entity hand, const Pose& hand_ws, const Tuning& tuning,
               StageStats& stats)
        : io_(io),
          hand_(hand),
          owner_(io.owner.at(hand)),
          hand_ws_(hand_ws),
          tuning_(tuning),
          stats_(stats) {}

    // Of all bodies, or of one alone.
    std::optional<Snap> find(Entity only) {
        for (std::size_t row = 0; row < io_.authored_grips.size(); ++row) {
            const AuthoredGrips& grips = io_.authored_grips.rows()[row];
            const Entity body = io_.authored_grips.owners()[row];
            if ((!is_null(only) && body != only) || !may_grip(io_, owner_, body)) {
                continue;
            }
            for (std::uint8_t i = 0; i < grips.count; ++i) {
                look_at(body, i, grips.grips[i]);
            }
        }
        return best_;
    }

  private:
    void look_at(Entity body, std::uint8_t place, const AuthoredGrip& grip) {
        const AuthoredHand& hand = grip.hands[index_of(owner_.side)];
        if (!hand.is_there) {
            return;
        }
        const Pose wrist_ws = io_.body_pose.at(body).pose_ws * hand.wrist_bs;
        Vec3 palm_hs = tuning_.hand.palm_center_m;
        palm_hs.x() *= owner_.side == HandSide::right ? 1.0 : -1.0;
        const GripSync sync = grip_sync(hand_ws_, wrist_ws, palm_hs);
        if (sync.palm_m > grip.snap_radius_m || sync.turn_rad > grip.snap_angle_rad) {
            return;
        }
        if (is_taken(io_, hand_, body, place)) {
            stats_.count(Fallback::authored_grip_occupied);
            return;
        }
        Snap snap;
        snap.body_id = io_.persistent_id.at(body).value;
        snap.surface = {body, transform_point(wrist_ws, palm_hs),
                        wrist_ws.rotation * Vec3::UnitY()};
        if (is_blocked(io_, owner_.player, transform_point(hand_ws_, palm_hs),
                       snap.surface.point_ws, snap.body_id)) {
            stats_.count(Fallback::authored_grip_blocked);
            return;
        }
        snap.hold = {body, place, hand, k_leave_factor * grip.snap_angle_rad};
        snap.priority = grip.priority;
        snap.sync_m = sync.palm_m + tuning_.palm.tilt_cost_m_per_rad * sync.turn_rad;
        if (!best_ || snap.is_before(*best_)) {
            best_ = snap;
        }
    }

    static constexpr double k_leave_factor = 2.0;

    const UpdateGrabsIo& io_;
    Entity hand_;
    const HandOwner& owner_;
    const Pose& hand_ws_;
    const Tuning& tuning_;
    StageStats& stats_;
    std::optional<Snap> best_;
};

GripKind grip_kind(const UpdateGrabsIo& io, Entity gripped, const PhaseTuning& tuning) {
    const RigidBody* const body = io.body.find(gripped);
    if (body == nullptr) {
        return GripKind::player;
    }
    const bool is_light = body->kind == BodyKind::free && body->mass_kg < tuning.heavy_body_kg;
    return is_light ? GripKind::held : GripKind::surface;
}

// True where what is gripped is still there.
bool is_there(const UpdateGrabsIo& io, const Grab& grab) {
    return grab.kind == GripKind::player ? io.origin.contains(grab.body)
                                         : io.body.contains(grab.body);
}

void ignore_for_head(HeadIgnores& ignores, Entity body, StageStats& stats) {
    if (std::find(ignores.bodies.begin(), ignores.bodies.end(), body) != ignores.bodies.end()) {
        return;
    }
    auto* place = std::find(ignores.bodies.begin(), ignores.bodies.end(), k_no_entity);
    if (place == ignores.bodies.end()) {
        stats.count(Fallback::head_ignores_full);
        place = &ignores.bodies[ignores.next];
        ignores.next = (ignores.next + 1) % HeadIgnores::k_capacity;
    }
    *place = body;
}

// Of a hand that closes, or of one that closed and has pulled near what it may only grip then.
struct Closing {
    Pose hand_ps;
    double since_s = 0.0;
    Entity only = k_no_entity;  // null: anything
};

// A pulled body is gripped where it touches the palm, or has come through it by a frame's way: not
// as far off as a hand reaches, for it would stay there.
bool is_at_palm(const Surface& surface, const PalmRay& ray) {
    constexpr double k_touches_m = 0.02;
    const Vec3 way = surface.point_ws - ray.palm_ws;
    return way.norm() <= k_touches_m || way.dot(ray.to_ws - ray.from_ws) <= 0.0;
}

void start_grab(const UpdateGrabsIo& io, Entity hand, const Surface& surface, double since_s,
                Grab& grab, const Tuning& tuning, StageStats& stats) {
    ++stats.grabs_gripped;
    const Pose body_ws = gripped_pose_ws(io.body_pose, io.origin, io.head, surface.body);
    grab = {};
    grab.kind = grip_kind(io, surface.body, tuning.phases);
    grab.jointed =
        grab.kind == GripKind::held && io.joint_groups.is_anchored(io.body.find_row(surface.body));
    grab.phase = GrabPhase::fresh;
    grab.body = surface.body;
    grab.since_s = since_s;
    grab.hit_bs = inverse_transform_point(body_ws, surface.point_ws);
    grab.hit_normal_bs = body_ws.rotation.conjugate() * surface.normal_ws;
    if (grab.kind == GripKind::held) {
        ignore_for_head(io.head_ignores.at(io.owner.at(hand).player), grab.body, stats);
    }
}

// For a body that only both hands grip: true if the player's other hand has it, or is closed on it
// and grips it from now on.
bool other_hand_joins(const UpdateGrabsIo& io, std::size_t row, Entity body, const Tuning& tuning,
                      StageStats& stats) {
    const std::size_t other = find_other_hand(io.owner, io.grab, row);
    if (other >= io.grab.size()) {
        return false;
    }
    const Entity entity = io.grab.owners()[other];
    const HandTracking& hand = io.hand.at(entity);
    Grab& grab = io.grab.rows()[other];
    if (grab.kind != GripKind::none || !hand.pressed || hand.state != TrackingState::tracked) {
        return grab.body == body && grab.phase != GrabPhase::releasing;
    }
    const bool closes_now = hand.edge == GrabEdge::onset;
    const HandOwner& owner = io.owner.at(entity);
    const Pose hand_ws =
        io.origin.at(owner.player).pose_ws * (closes_now ? hand.edge_ps : hand.start_ps);
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const auto surface = SurfaceFinder(io, owner).find(ray, tuning.hand);
    if (!surface || surface->body != body) {
        return false;
    }
    const double since_s = closes_now ? hand.edge_t_s : io.hand.at(io.grab.owners()[row]).edge_t_s;
    start_grab(io, entity, *surface, since_s, grab, tuning, stats);
    return true;
}

void begin_grab(const UpdateGrabsIo& io, std::size_t row, const Closing& closing,
                const Tuning& tuning, StageStats& stats) {
    const Entity entity = io.grab.owners()[row];
    const HandOwner& owner = io.owner.at(entity);
    const Pose hand_ws = io.origin.at(owner.player).pose_ws * closing.hand_ps;
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const auto snap = SnapFinder(io, entity, hand_ws, tuning, stats).find(closing.only);
    SurfaceFinder finder(io, owner);
    const auto surface = snap ? std::optional(snap->surface) : finder.find(ray, tuning.hand);
    if (!is_null(closing.only) &&
        (!surface || surface->body != closing.only || !(snap || is_at_palm(*surface, ray)))) {
        return;  // it is still on its way
    }
    io.authored_hold.remove(entity);
    if (!surface) {
        stats.note(is_null(finder.refused_by()) ? Fallback::grab_no_surface
                                                : Fallback::grab_refused_by_rule,
                   entity, finder.refused_by());
        return;
    }
    const GrabRule* const rule = find_in(io.rule, surface->body);
    if (rule != nullptr && rule->two_hands &&
        !other_hand_joins(io, row, surface->body, tuning, stats)) {
        stats.note(Fallback::grab_needs_two_hands, entity, surface->body);
        return;
    }
    if (snap) {
        io.authored_hold.add(entity, snap->hold);
    }
    start_grab(io, entity, *surface, closing.since_s, io.grab.rows()[row], tuning, stats);
}

// The row of the player's other hand, where that grips something too.
std::optional<std::size_t> partner_of(const UpdateGrabsIo& io, std::size_t row) {
    const std::size_t other = find_other_hand(io.owner, io.grab, row);
    return other < io.grab.size() && io.grab.rows()[other].kind != GripKind::none
               ? std::optional(other)
               : std::nullopt;
}

// Where what is gripped is at the frame's start.
Pose gripped_start_ws(const UpdateGrabsIo& io, Entity gripped) {
    const BodyPose* const body = io.body_pose.find(gripped);
    return body != nullptr ? body->pose_ws
                           : io.origin.at(gripped).pose_ws * io.head.at(gripped).start_ps;
}

// The hand lets go now. Another with which it shared what they could not both have holds on from
// where it is, before anything has moved: nobody is drawn to where it closed.
void release_grab(const UpdateGrabsIo& io, std::size_t row, Fallback reason, StageStats& stats) {
    Grab& grab = io.grab.rows()[row];
    stats.note(reason, io.grab.owners()[row], grab.body);
    if (const std::optional<std::size_t> partner = partner_of(io, row)) {
        Grab& staying = io.grab.rows()[*partner];
        const Entity hand = io.grab.owners()[*partner];
        // Of hands that lead a free body together anchor_grabs takes care.
        if (share_hold(grab, staying) && !share_free_body(grab, staying) && is_there(io, staying)) {
            const Pose hand_ws =
                io.origin.at(io.owner.at(hand).player).pose_ws * io.hand.at(hand).start_ps;
            staying.anchor_bs = inverse(gripped_start_ws(io, staying.body)) * hand_ws;
            staying.error_m = 0.0;
            stats.count(Fallback::grip_reanchored);
        }
    }
    grab = {};
}

// Of a player's two hands the one that is stretched more lets go, of two alike the one that grips
// for the shorter time, of two that closed at once the left one: what is left may then be met.
bool yields_to_partner(const UpdateGrabsIo& io, std::size_t row, std::size_t partner) {
    const Grab& grab = io.grab.rows()[row];
    const Grab& other = io.grab.rows()[partner];
    constexpr double k_alike_m = 1e-6;
    const double difference = grab.error_m - other.error_m;
    if (std::abs(difference) > k_alike_m) {
        return difference > 0.0;
    }
    return grab.since_s != other.since_s
               ? grab.since_s > other.since_s
               : io.owner.at(io.grab.owners()[row]).side == HandSide::left;
}

void release_destroyed_bodies(const UpdateGrabsIo& io, StageStats& stats) {
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const Grab& grab = io.grab.rows()[row];
        if (grab.kind != GripKind::none && !is_there(io, grab)) {
            release_grab(io, row, Fallback::grip_body_gone, stats);
        }
    }
}

// Hands that grip alone first: whose partner lets go here is left to the next frame.
void release_overstretched_grabs(const UpdateGrabsIo& io, double max_stretch_m, StageStats& stats) {
    for (const bool alone : {true, false}) {
        for (std::size_t row = 0; row < io.grab.size(); ++row) {
            const Grab& grab = io.grab.rows()[row];
            if (grab.kind == GripKind::none || grab.error_m <= max_stretch_m) {
                continue;
            }
            const std::optional<std::size_t> partner = partner_of(io, row);
            if (alone != partner.has_value() && (alone || yields_to_partner(io, row, *partner))) {
                release_grab(io, row, Fallback::grip_stretched, stats);
            }
        }
    }
}

// What a hand sits in ends with its grip, and where a hand that may turn on what it grips has
// turned too far away.
void update_authored_hold(const UpdateGrabsIo& io, Entity entity, const Grab& grab,
                          StageStats& stats) {
    const AuthoredHold* const hold = io.authored_hold.find(entity);
    if (hold == nullptr) {
        return;
    }
    bool stays = grab.kind != GripKind::none && grab.body == hold->body;
    const bool may_turn = grab.kind != GripKind::held || grab.jointed || grab.two_handed;
    if (stays && may_turn) {
        const Quat hand_ws = io.origin.at(io.owner.at(entity).player).pose_ws.rotation *
                             io.hand.at(entity).start_ps.rotation;
        const Quat grip_ws =
            io.body_pose.at(hold->body).pose_ws.rotation * hold->hand.wrist_bs.rotation;
        stays = rotation_to_vector((hand_ws.conjugate() * grip_ws).normalized()).norm() <=
                hold->leave_angle_rad;
        if (!stays) {
            stats.count(Fallback::authored_grip_abandoned);
        }
    }
    if (!stays) {
        io.authored_hold.remove(entity);
    }
}

// One of both hands left a body that needs them, or leaves it now.
void release_half_held_bodies(const UpdateGrabsIo& io, StageStats& stats) {
    if (io.rule == nullptr) {
        return;
    }
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const Grab& grab = io.grab.rows()[row];
        const GrabRule* const rule = io.rule->find(grab.body);
        if (grab.kind == GripKind::none || grab.phase == GrabPhase::releasing || rule == nullptr ||
            !rule->two_hands) {
            continue;
        }
        const std::optional<std::size_t> partner = partner_of(io, row);
        const bool is_whole = partner && io.grab.rows()[*partner].body == grab.body &&
                              io.grab.rows()[*partner].phase != GrabPhase::releasing;
        if (!is_whole) {
            release_grab(io, row, Fallback::grip_needs_two_hands, stats);
        }
    }
}

void carry_out_orders(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    while (io.order != nullptr && !io.order->empty()) {
        const Entity hand = io.order->owners().front();
        const Entity body = io.order->rows().front().body;
        io.order->remove(hand);
        const std::size_t row = io.grab.find_row(hand);
        const bool has_body = io.body.contains(body) ||
                              (io.origin.contains(body) && body != io.owner.at(hand).player &&
                               io.head.at(body).state != TrackingState::never);
        if (io.grab.rows()[row].kind != GripKind::none) {
            release_grab(io, row, Fallback::grip_ended_by_host, stats);
            io.authored_hold.remove(hand);
        }
        if (!has_body || io.hand.at(hand).state == TrackingState::never) {
            continue;
        }
        const HandOwner& owner = io.owner.at(hand);
        const Pose hand_ws = io.origin.at(owner.player).pose_ws * io.hand.at(hand).start_ps;
        const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
        const Surface surface{body, ray.palm_ws, hand_ws.rotation * Vec3::UnitY()};
        start_grab(io, hand, surface, io.start_s, io.grab.rows()[row], tuning, stats);
    }
}

}  // namespace

void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    release_destroyed_bodies(io, stats);
    release_overstretched_grabs(io, tuning.hand.max_stretch_m, stats);
    carry_out_orders(io, tuning, stats);
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        Grab& grab = io.grab.rows()[row];
        const Entity entity = io.grab.owners()[row];
        const HandTracking& hand = io.hand.at(entity);
        if (grab.kind != GripKind::none && hand.edge == GrabEdge::release) {
            grab.phase = GrabPhase::releasing;
        }
        update_authored_hold(io, entity, grab, stats);
        const HandPull* const pull = io.pull.find(entity);
        if (hand.edge == GrabEdge::onset) {
            ++stats.grab_onsets;
            begin_grab(io, row, {hand.edge_ps, hand.edge_t_s, k_no_entity}, tuning, stats);
        } else if (pull != nullptr && hand.edge == GrabEdge::none && hand.pressed &&
                   hand.state == TrackingState::tracked && !hand.resumed &&
                   grab.kind == GripKind::none) {
            begin_grab(io, row, {hand.start_ps, pull->closed_s, pull->body}, tuning, stats);
        }
    }
    release_half_held_bodies(io, stats);
}

}  // namespace handhold
