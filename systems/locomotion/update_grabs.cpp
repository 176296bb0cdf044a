#include "systems/locomotion/update_grabs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "components/play_space.hpp"

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

void begin_grab(const UpdateGrabsIo& io, const HandOwner& owner, const HandTracking& hand,
                Grab& grab, const Tuning& tuning, StageStats& stats) {
    ++stats.grab_onsets;
    const Pose hand_ws = io.origin.at(owner.player).pose_ws * hand.edge_ps;
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const auto surface = find_surface(io, owner.player, ray, tuning.hand);
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
    grab.since_s = hand.edge_t_s;
    grab.hit_bs = inverse_transform_point(body_ws, surface->point_ws);
    grab.hit_normal_bs = body_ws.rotation.conjugate() * surface->normal_ws;
    if (grab.kind == GripKind::held) {
        ignore_for_head(io.head_ignores.at(owner.player), grab.body, stats);
    }
}

// Of a player's two hands the one that is stretched more lets go, of two alike the one that grips
// for the shorter time: what is left may then be met.
bool gives_way(const UpdateGrabsIo& io, std::size_t row) {
    const Grab& grab = io.grab.rows()[row];
    const Entity player = io.owner.at(io.grab.owners()[row]).player;
    for (std::size_t other = 0; other < io.grab.size(); ++other) {
        const Grab& candidate = io.grab.rows()[other];
        if (other == row || candidate.kind == GripKind::none ||
            io.owner.at(io.grab.owners()[other]).player != player) {
            continue;
        }
        constexpr double k_alike_m = 1e-6;
        const double difference = grab.error_m - candidate.error_m;
        return std::abs(difference) > k_alike_m ? difference > 0.0
                                                : grab.since_s >= candidate.since_s;
    }
    return true;
}

}  // namespace

void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        Grab& grab = io.grab.rows()[row];
        const Entity entity = io.grab.owners()[row];
        const HandTracking& hand = io.hand.at(entity);
        if (grab.kind != GripKind::none && !is_there(io, grab)) {
            stats.count(Fallback::grip_body_gone);
            grab = {};
        }
        if (grab.kind != GripKind::none && grab.error_m > tuning.hand.max_stretch_m &&
            gives_way(io, row)) {
            stats.count(Fallback::grip_stretched);
            grab = {};
        }
        if (grab.kind != GripKind::none && hand.edge == GrabEdge::release) {
            grab.phase = GrabPhase::releasing;
        }
        if (hand.edge == GrabEdge::onset) {
            begin_grab(io, io.owner.at(entity), hand, grab, tuning, stats);
        }
    }
}

}  // namespace handhold
