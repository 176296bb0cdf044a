#include "systems/grab/shared/grab_search.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "components/play_space.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/grab/shared/grab_sight.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

Entity owner_of_id(const GrabSearch& io, std::uint64_t id) {
    for (const std::span<const Entity> owners : {io.body.owners(), io.origin.owners()}) {
        for (const Entity entity : owners) {
            if (io.persistent_id.at(entity).value == id) {
                return entity;
            }
        }
    }
    return k_no_entity;
}

bool any_priority(const GrabRules& rules) {
    return std::ranges::any_of(rules.rule.elements(),
                               [](const GrabRule& rule) { return rule.priority != 0; });
}

// A point of a collider, or of another player's part.
struct FoundSurface {
    std::uint64_t id = 0;
    Vec3 point_ws;
    Vec3 normal_ws;
    std::optional<BodyPart> part;
};

// Returns the nearer of the two hits.
template <typename ColliderHit>
std::optional<FoundSurface> nearer(const std::optional<ColliderHit>& collider,
                                   const std::optional<PartHit>& part) {
    if (part && (!collider || part->distance_m < collider->distance_m)) {
        return FoundSurface{part->id, part->point_ws, part->normal_ws, part->part};
    }
    return collider ? std::optional(FoundSurface{collider->id, collider->point_ws,
                                                 collider->normal_ws, std::nullopt})
                    : std::nullopt;
}

// Fingers can go round a body that is at least this far from a point beside and below its surface.
constexpr double k_round_beside_m = 0.05;
constexpr double k_round_below_m = 0.005;
constexpr double k_round_free_m = 0.015;

// A hand grips the surface of highest rank.
struct SurfaceRank {
    std::int32_t priority = 0;  // GrabRule::priority
    bool is_round = false;      // fingers can go round it: a rail, a handle, an edge
    auto operator<=>(const SurfaceRank&) const = default;
};

// Searches along the palm ray, then around the palm, without testing visibility. Skips surfaces
// that refuse the hand. Takes the first other surface, or one of a higher rank that no other
// surface hides from the palm. Only a surface within k_round_reach_m is preferred because fingers
// can go round it. Other players' heads and bodies count as surfaces.
class SurfaceFinder {
  public:
    // `fingers_ws`: direction of the straight fingers.
    SurfaceFinder(const GrabSearch& io, const HandOwner& owner, const PalmRay& ray,
                  const Vec3& fingers_ws)
        : io_(io),
          owner_(owner),
          ray_(ray),
          fingers_ws_(fingers_ws),
          scale_(io.origin.at(owner.player).scale),
          continues_(any_priority(io.rules)) {
        const std::uint64_t own_head = io.persistent_id.at(owner.player).value;
        skipped_.add(own_head);
        refusing_.add(own_head);
    }

    // Nullopt if nothing is in reach, or only bodies that refuse the hand (refused_by).
    std::optional<GrabTarget> find(double reach_m) {
        while (needs_any() && offer(on_ray())) {
        }
        while (!is_done() && offer(near_palm(needs_any() ? reach_m : scale_ * k_round_reach_m))) {
        }
        return best_;
    }
    Entity refused_by() const { return refused_by_; }

  private:
    struct Ids {
        std::array<std::uint64_t, 16> ids{};
        std::size_t count = 0;
        std::span<const std::uint64_t> view() const { return std::span(ids).first(count); }
        bool is_full() const { return count == ids.size(); }
        void add(std::uint64_t id) { ids[count++] = id; }
    };

    std::optional<FoundSurface> on_ray() const {
        const GrippableBodies::Skip skip = skipped_.view();
        return nearer(io_.surfaces.cast_ray(ray_.from_ws, ray_.to_ws, skip),
                      io_.bodies().cast_ray(ray_.from_ws, ray_.to_ws, skip));
    }
    std::optional<FoundSurface> near_palm(double reach_m) const {
        const GrippableBodies::Skip skip = skipped_.view();
        return nearer(io_.surfaces.closest_point(ray_.palm_ws, reach_m, skip),
                      io_.bodies().closest_point(ray_.palm_ws, reach_m, skip));
    }

    // False: only a nearby surface that fingers can go round would be better than the best one.
    bool needs_any() const { return !best_ || continues_; }
    bool is_done() const { return skipped_.is_full() || (!needs_any() && rank_.is_round); }

    // True if the body ends beside the point in the fingers' direction or across it.
    bool is_round(const FoundSurface& found) const {
        if (found.part) {
            return *found.part < BodyPart::upper_spine || *found.part > BodyPart::lower_spine;
        }
        const Vec3& normal = found.normal_ws;
        const Vec3 across = normal.cross(fingers_ws_);
        const Vec3 sideways =
            across.norm() > 0.1 ? Vec3(across.normalized()) : Vec3(any_perpendicular(normal));
        const Vec3 ahead = sideways.cross(normal);
        return std::ranges::any_of(
            std::array{ahead, Vec3(-ahead), sideways, Vec3(-sideways)}, [&](const Vec3& way) {
                const Vec3 beside = found.point_ws + scale_ * k_round_beside_m * way;
                const Vec3 rise = scale_ * k_round_below_m * normal;
                const auto wall = io_.surfaces.cast_ray(found.point_ws + rise, beside + rise);
                if (wall && wall->id == found.id) {
                    return false;  // an inner corner
                }
                const auto near = io_.surfaces.closest_point_on(found.id, beside - rise);
                return near && near->distance_m > scale_ * k_round_free_m;
            });
    }

    SurfaceRank rank_of(const FoundSurface& found, Entity body) const {
        const GrabRule* const rule = io_.rules.rule_of(body);
        const bool is_near = (found.point_ws - ray_.palm_ws).norm() <= scale_ * k_round_reach_m;
        return {rule != nullptr ? rule->priority : 0, (!best_ || is_near) && is_round(found)};
    }

    bool is_hidden(std::uint64_t id, const Vec3& point_ws) const {
        const auto hit = io_.surfaces.cast_ray(ray_.palm_ws, point_ws, refusing_.view());
        return hit && hit->id != id;
    }

    // Accepts or rejects a found surface. Returns false if the search must stop.
    bool offer(const std::optional<FoundSurface>& found) {
        const Entity body = found ? owner_of_id(io_, found->id) : k_no_entity;
        if (is_null(body)) {
            return false;
        }
        skipped_.add(found->id);
        if (!io_.rules.allow(owner_, body)) {
            refused_by_ = body;
            refusing_.add(found->id);
            return !is_done();
        }
        const SurfaceRank rank = rank_of(*found, body);
        if (!best_ || (rank > rank_ && !is_hidden(found->id, found->point_ws))) {
            best_ = GrabTarget{body, found->point_ws, found->normal_ws, {}, found->part};
            rank_ = rank;
        }
        return !is_done();
    }

    const GrabSearch& io_;
    const HandOwner& owner_;
    const PalmRay& ray_;
    Vec3 fingers_ws_;
    double scale_;
    bool continues_;  // true: searches past the first surface for one of higher priority
    Ids skipped_;     // already offered
    Ids refusing_;    // own head, and those of skipped_ that refuse the hand
    std::optional<GrabTarget> best_;
    SurfaceRank rank_;  // rank of the best one
    Entity refused_by_ = k_no_entity;
};

// Returns the surface at the palm if the hand can reach it without crossing a wall. If the palm was
// pushed through a surface, returns that surface.
GrabSearchResult find_visible_surface(const GrabSearch& io, const HandOwner& owner,
                                      const PalmRay& ray, const Vec3& fingers_ws,
                                      const SightLines& sight, const HandTuning& tuning) {
    const auto refused_by = [](Entity body) {
        return GrabSearchResult{{}, Fallback::grab_refused_by_rule, body};
    };
    SurfaceFinder finder(io, owner, ray, fingers_ws);
    const auto surface = finder.find(tuning.reach_m);
    if (!surface) {
        return is_null(finder.refused_by()) ? GrabSearchResult{} : refused_by(finder.refused_by());
    }
    const std::uint64_t surface_id = io.persistent_id.at(surface->body).value;
    if (sight.may_grip(ray.palm_ws, surface->point_ws, surface_id, SightLines::Needs::this_point)) {
        return {surface};
    }
    const auto entry = sight.entry(ray.palm_ws);
    const Entity body = entry ? owner_of_id(io, entry->id) : k_no_entity;
    const double max_m = body == surface->body ? tuning.max_stretch_m : tuning.reach_m;
    if (!is_null(body) && (entry->point_ws - ray.palm_ws).norm() <= max_m) {
        return io.rules.allow(owner, body)
                   ? GrabSearchResult{GrabTarget{body, entry->point_ws, entry->normal_ws, {}}}
                   : refused_by(body);
    }
    return {{}, Fallback::grab_out_of_sight, surface->body};
}

// An authored grip that a hand may snap to.
struct Snap {
    GrabTarget target;  // target whose point is the palm's centre in the grip
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
        return body_id != other.body_id ? body_id < other.body_id
                                        : target.hold->grip < other.target.hold->grip;
    }
};

// True if another hand sits in the grip.
bool is_taken(const GrabSearch& io, Entity own_hand, Entity body, std::uint8_t grip) {
    for (std::size_t index = 0; index < io.authored_hold.size(); ++index) {
        const Entity hand = io.authored_hold.owners()[index];
        const AuthoredHold& hold = io.authored_hold.elements()[index];
        const Grab& grab = io.grab.at(hand);
        if (hand != own_hand && hold.body == body && hold.grip == grip && grab.body == body &&
            grab.kind != GripKind::none && grab.phase != GrabPhase::releasing) {
            return true;
        }
    }
    return false;
}

// True if another body stands between the palm and its place in the grip.
bool is_blocked(const GrabSearch& io, Entity player, const Vec3& from_ws, const Vec3& to_ws,
                std::uint64_t body_id) {
    constexpr double k_there_m = 1e-6;
    if ((to_ws - from_ws).norm() < k_there_m) {
        return false;
    }
    const std::array own_head = {io.persistent_id.at(player).value};
    const auto hit = io.surfaces.cast_ray(from_ws, to_ws, own_head);
    return hit && hit->id != body_id;
}

class SnapFinder {
  public:
    SnapFinder(const GrabSearch& io, Entity hand, const Pose& hand_ws, const SightLines& sight,
               const Tuning& tuning, StageStats& stats)
        : io_(io),
          hand_(hand),
          owner_(io.owner.at(hand)),
          hand_ws_(hand_ws),
          sight_(sight),
          tuning_(tuning),
          stats_(stats) {}

    // `only`: searches only this body's grips; null: the grips of all bodies.
    std::optional<Snap> find(Entity only) {
        for (std::size_t index = 0; index < io_.authored_grips.size(); ++index) {
            const AuthoredGrips& grips = io_.authored_grips.elements()[index];
            const Entity body = io_.authored_grips.owners()[index];
            if ((!is_null(only) && body != only) || !io_.rules.allow(owner_, body)) {
                continue;
            }
            for (std::uint8_t i = 0; i < grips.count; ++i) {
                consider(body, i, grips.grips[i]);
            }
        }
        return best_;
    }

  private:
    void consider(Entity body, std::uint8_t place, const AuthoredGrip& grip) {
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
        snap.target = {body, transform_point(wrist_ws, palm_hs), wrist_ws.rotation * Vec3::UnitY(),
                       AuthoredHold{body, place, hand, k_leave_factor * grip.snap_angle_rad}};
        const Vec3 palm_ws = transform_point(hand_ws_, palm_hs);
        if (is_blocked(io_, owner_.player, palm_ws, snap.target.point_ws, snap.body_id) ||
            !sight_.may_grip(palm_ws, snap.target.point_ws, snap.body_id,
                             SightLines::Needs::any_point)) {
            stats_.count(Fallback::authored_grip_blocked);
            return;
        }
        snap.priority = grip.priority;
        snap.sync_m = sync.palm_m + tuning_.palm.tilt_cost_m_per_rad * sync.turn_rad;
        if (!best_ || snap.is_before(*best_)) {
            best_ = snap;
        }
    }

    static constexpr double k_leave_factor = 2.0;

    const GrabSearch& io_;
    Entity hand_;
    const HandOwner& owner_;
    const Pose& hand_ws_;
    const SightLines& sight_;
    const Tuning& tuning_;
    StageStats& stats_;
    std::optional<Snap> best_;
};

}  // namespace

GrabSearchResult find_surface_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                     const Tuning& tuning) {
    const HandOwner& owner = io.owner.at(hand);
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const SightSkips skips = sight_skips(io, hand);
    const SightLines sight = sight_lines(io, hand, ray.palm_ws, skips, tuning.head);
    return find_visible_surface(io, owner, ray, hand_ws.rotation * -Vec3::UnitZ(), sight,
                                tuning.hand);
}

std::optional<GrabTarget> find_snap_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                           Entity only, const Tuning& tuning, StageStats& stats) {
    const HandOwner& owner = io.owner.at(hand);
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const SightSkips skips = sight_skips(io, hand);
    const SightLines sight = sight_lines(io, hand, ray.palm_ws, skips, tuning.head);
    const auto snap = SnapFinder(io, hand, hand_ws, sight, tuning, stats).find(only);
    return snap ? std::optional(snap->target) : std::nullopt;
}

GrabSearchResult find_grab_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                  Entity only, const Tuning& tuning, StageStats& stats) {
    if (const auto snap = find_snap_target(io, hand, hand_ws, only, tuning, stats)) {
        return {snap};
    }
    return find_surface_target(io, hand, hand_ws, tuning);
}

}  // namespace handhold
