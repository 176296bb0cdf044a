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
    for (std::size_t row = 0; row < io.body.size(); ++row) {
        const Entity entity = io.body.owners()[row];
        if (io.persistent_id.at(entity).value == id) {
            return entity;
        }
    }
    return k_no_entity;
}

// The first body that a query finds. Heads are colliders too, but nothing to hold on to: it is
// asked again without them.
template <typename Query>
std::optional<Surface> first_body(const UpdateGrabsIo& io, Query&& query) {
    std::array<std::uint64_t, 8> heads{};
    for (std::size_t count = 0;; ++count) {
        const auto found = query(std::span<const std::uint64_t>(heads).first(count));
        if (!found) {
            return std::nullopt;
        }
        const Entity body = owner_of_id(io, found->id);
        if (!is_null(body)) {
            return Surface{body, found->point_ws, found->normal_ws};
        }
        if (count == heads.size()) {
            return std::nullopt;
        }
        heads[count] = found->id;
    }
}

std::optional<Surface> find_surface(const UpdateGrabsIo& io, const PalmRay& ray,
                                    const HandTuning& tuning) {
    auto hit = first_body(io, [&](std::span<const std::uint64_t> skip) {
        return io.collision.cast_ray(ray.from_ws, ray.to_ws, skip);
    });
    if (hit) {
        return hit;
    }
    return first_body(io, [&](std::span<const std::uint64_t> skip) {
        return io.collision.closest_point(ray.palm_ws, tuning.reach_m, skip);
    });
}

GripKind grip_kind(const RigidBody& body, const PhaseTuning& tuning) {
    return body.kind == BodyKind::free && body.mass_kg < tuning.heavy_body_kg ? GripKind::held
                                                                              : GripKind::surface;
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
    const auto surface = find_surface(io, palm_ray(hand_ws, owner.side, tuning.hand), tuning.hand);
    if (!surface) {
        stats.count(Fallback::grab_no_surface);
        return;
    }
    ++stats.grabs_gripped;
    const Pose& body_ws = io.body_pose.at(surface->body).pose_ws;
    grab = {};
    grab.kind = grip_kind(io.body.at(surface->body), tuning.phases);
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
        if (grab.kind != GripKind::none && !io.body.contains(grab.body)) {
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
