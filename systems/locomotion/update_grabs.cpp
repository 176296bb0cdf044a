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

// Anybody's head may be gripped but one's own.
std::optional<Surface> find_surface(const UpdateGrabsIo& io, Entity player, const PalmRay& ray,
                                    const HandTuning& tuning) {
    const std::array own_head = {io.persistent_id.at(player).value};
    const auto surface_of = [&io](const auto& found) -> std::optional<Surface> {
        const Entity body = found ? owner_of_id(io, found->id) : k_no_entity;
        if (is_null(body)) {
            return std::nullopt;
        }
        return Surface{body, found->point_ws, found->normal_ws};
    };
    const auto hit = surface_of(io.collision.cast_ray(ray.from_ws, ray.to_ws, own_head));
    return hit ? hit
               : surface_of(io.collision.closest_point(ray.palm_ws, tuning.reach_m, own_head));
}

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
            if (!is_null(only) && body != only) {
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

void begin_grab(const UpdateGrabsIo& io, Entity entity, const Closing& closing, Grab& grab,
                const Tuning& tuning, StageStats& stats) {
    const HandOwner& owner = io.owner.at(entity);
    const Pose hand_ws = io.origin.at(owner.player).pose_ws * closing.hand_ps;
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const auto snap = SnapFinder(io, entity, hand_ws, tuning, stats).find(closing.only);
    const auto surface =
        snap ? std::optional(snap->surface) : find_surface(io, owner.player, ray, tuning.hand);
    if (!is_null(closing.only) &&
        (!surface || surface->body != closing.only || !(snap || is_at_palm(*surface, ray)))) {
        return;  // it is still on its way
    }
    io.authored_hold.remove(entity);
    if (snap) {
        io.authored_hold.add(entity, snap->hold);
    }
    if (!surface) {
        stats.count(Fallback::grab_no_surface);
        return;
    }
    ++stats.grabs_gripped;
    const Pose body_ws = gripped_pose_ws(io.body_pose, io.origin, io.head, surface->body);
    grab = {};
    grab.kind = grip_kind(io, surface->body, tuning.phases);
    grab.jointed =
        grab.kind == GripKind::held && io.joint_groups.is_anchored(io.body.find_row(surface->body));
    grab.phase = GrabPhase::fresh;
    grab.body = surface->body;
    grab.since_s = closing.since_s;
    grab.hit_bs = inverse_transform_point(body_ws, surface->point_ws);
    grab.hit_normal_bs = body_ws.rotation.conjugate() * surface->normal_ws;
    if (grab.kind == GripKind::held) {
        ignore_for_head(io.head_ignores.at(owner.player), grab.body, stats);
    }
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
    stats.count(reason);
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

}  // namespace

void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    release_destroyed_bodies(io, stats);
    release_overstretched_grabs(io, tuning.hand.max_stretch_m, stats);
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
            begin_grab(io, entity, {hand.edge_ps, hand.edge_t_s, k_no_entity}, grab, tuning, stats);
        } else if (pull != nullptr && hand.edge == GrabEdge::none && hand.pressed &&
                   hand.state == TrackingState::tracked && !hand.resumed &&
                   grab.kind == GripKind::none) {
            begin_grab(io, entity, {hand.start_ps, pull->closed_s, pull->body}, grab, tuning,
                       stats);
        }
    }
}

}  // namespace handhold
