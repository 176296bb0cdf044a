#include "systems/hand/shared/palm_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "engine/geometry/closest_point.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr int k_max_iterations = 6;
constexpr int k_min_iterations = 2;  // iterations before a fit can be abandoned
// Minimum of PalmTuning::rotation_arm_m: at 0 rotation would cost nothing.
constexpr double k_min_arm_m = 1e-3;
// Initial value of step_m, so that the fit does not count as converged.
constexpr double k_first_step_m = 1.0;
constexpr double k_penetration_slop_m = 5e-5;  // smaller penetrations are not corrected
// Query radius: a sphere's centre deeper inside a solid is not found.
constexpr double k_max_inside_m = 0.03;

// Returns the shortest translation parallel to the triangle's plane that brings the palm over the
// triangle.
Vec3 offset_onto_triangle(const PlacedMesh& placed, std::uint32_t triangle, const Vec3& center_bs) {
    const SurfaceGraph& graph = placed.mesh->search;
    const Corners corners = corners_of(graph, triangle);
    const Vec3 center = inverse_transform_point(placed.pose, center_bs);
    const Vec3& normal = graph.normals[triangle];
    const Vec3 in_plane = center - (center - corners[0]).dot(normal) * normal;
    return placed.pose.rotation * Vec3(closest_on_triangle(in_plane, corners) - in_plane);
}

// Turns the rotation by the smallest angle that brings the palm's tilt against `normal` to at most
// `max_rad`.
Quat clamp_tilt(const Quat& rotation, const HandRig& rig, const Vec3& normal, double max_rad) {
    const Vec3 up = rotation * -rig.palm_normal_hs;
    const Vec3 across = up.cross(normal);
    const double angle_rad = arc_tangent2(across.norm(), up.dot(normal));
    if (angle_rad <= max_rad || across.norm() <= 1e-9) {
        return rotation;
    }
    return (rotation_about(across.normalized(), angle_rad - max_rad) * rotation).normalized();
}

// Moves the tracked wrist into the height limits, then into the tilt limit. Tilting about the
// palm's centre does not change the palm's height.
Pose clamp_to_limits(const HandSurroundings& hand, const Pose& tracked_bs,
                     const GripSurface& surface, const PalmTuning& tuning) {
    const HandRig& rig = *hand.rig;
    const Vec3& normal = surface.normal_bs;
    Vec3 center = transform_point(tracked_bs, rig.palm_center_hs);
    center += offset_onto_triangle(hand.meshes.front(), surface.triangle, center);
    const double height_m = (center - surface.point_bs).dot(normal);
    const double wanted_m = std::clamp(height_m, tuning.min_height_m,
                                       std::max(tuning.min_height_m, tuning.max_height_m));
    center += (wanted_m - height_m) * normal;

    Pose wrist = tracked_bs;
    wrist.rotation = clamp_tilt(wrist.rotation, rig, normal, tuning.max_angle_rad);
    wrist.position = center - wrist.rotation * rig.palm_center_hs;
    return wrist;
}

// One inequality of the fit: gap >= 0. A small move (translation t, rotation vector r about the
// palm's centre) changes the gap by along . t + turn . r.
struct PalmGap {
    Vec3 along = Vec3::Zero();
    Vec3 turn = Vec3::Zero();
    double gap_m = 0.0;  // negative: violated
};

class PalmGaps {
  public:
    void clear() { count_ = 0; }
    // Ignores the gap when the array is full, except for k_max_limits elements that are reserved
    // for the limits.
    void add_contact(const PalmGap& gap) {
        if (count_ < k_max_gaps - k_max_limits) {
            gaps_[count_++] = gap;
        }
    }
    // Precondition: at most k_max_limits calls since the last clear().
    void add_limit(const PalmGap& gap) { gaps_[count_++] = gap; }
    std::span<const PalmGap> all() const { return {gaps_.data(), count_}; }

    static constexpr std::size_t k_max_limits = 3;
    static constexpr std::size_t k_max_gaps = 256;  // enough for a curled hand among five bodies

  private:
    std::array<PalmGap, k_max_gaps> gaps_;  // NOLINT(*-member-init): filled as it grows
    std::size_t count_ = 0;
};

// Adds the limits on height and tilt.
void add_limits(const HandSurroundings& hand, const GripSurface& surface, const Pose& wrist,
                const PalmTuning& tuning, double arm_m, PalmGaps& gaps) {
    const Vec3& normal = surface.normal_bs;
    const Vec3 center = transform_point(wrist, hand.rig->palm_center_hs);
    const double height_m = (center - surface.point_bs).dot(normal);
    const double max_height_m = std::max(tuning.min_height_m, tuning.max_height_m);
    gaps.add_limit({normal, Vec3::Zero(), height_m - tuning.min_height_m});
    gaps.add_limit({-normal, Vec3::Zero(), max_height_m - height_m});
    const Vec3 up = wrist.rotation * -hand.rig->palm_normal_hs;
    const Vec3 across = up.cross(normal);
    if (across.norm() > 1e-9) {
        const double angle_rad = arc_tangent2(across.norm(), up.dot(normal));
        gaps.add_limit({Vec3::Zero(), arm_m * across.normalized(),
                        arm_m * (tuning.max_angle_rad - angle_rad)});
    }
}

// Queries the gaps between the palm with its open fingers and the surfaces near it. Three spheres
// along each capsule approximate the hand. A triangle's winding tells which side is outside. On the
// gripped mesh the sides are swapped if the palm is fitted to a backface.
class PalmSpheres {
  public:
    PalmSpheres(const HandSurroundings& hand, const GripSurface& surface) : hand_(hand) {
        const PlacedMesh& placed = hand.meshes.front();
        const Vec3 wound = placed.pose.rotation * placed.mesh->search.normals[surface.triangle];
        side_ = wound.dot(surface.normal_bs) < 0.0 ? -1.0 : 1.0;
        for (const FingerRig& finger : hand.rig->fingers) {
            if (finger.name != FingerName::thumb) {
                add_open_finger(finger);
            }
        }
    }

    // With the hand at `wrist`, adds the gap between every sphere and its nearest surface point,
    // unless that point is outside the query radius. Returns the largest penetration of the palm,
    // at least 0.
    double query(const Pose& wrist, PalmGaps& gaps) {
        std::size_t cache_index = 0;
        double deepest_m = 0.0;
        for (const PalmCapsule& capsule : hand_.rig->palm) {
            deepest_m = std::max(deepest_m, query_capsule(wrist, capsule, 0, cache_index, gaps));
        }
        finger_penetration_m_ = 0.0;
        for (std::size_t i = 0; i < link_count_; ++i) {
            finger_penetration_m_ =
                std::max(finger_penetration_m_,
                         query_capsule(wrist, links_[i], is_first_[i] ? 0 : 1, cache_index, gaps));
        }
        return deepest_m;
    }
    // Largest penetration of the open fingers at the last query().
    double finger_penetration_m() const { return finger_penetration_m_; }

  private:
    void add_open_finger(const FingerRig& finger) {
        const auto points = finger_points(finger, {finger.lower_rad, 0.0});
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            is_first_[link_count_] = i == 0;
            links_[link_count_++] = {points[i], points[i + 1], finger.radius_m[i]};
        }
    }

    // Skips the spheres before `first`. For a finger link, `first` is 1 if the previous link's last
    // sphere is at the same point.
    double query_capsule(const Pose& wrist, const PalmCapsule& capsule, int first,
                         std::size_t& cache_index, PalmGaps& gaps) {
        constexpr int k_spheres = 3;
        double deepest_m = 0.0;
        const Vec3 middle = transform_point(wrist, hand_.rig->palm_center_hs);
        for (int i = first; i < k_spheres; ++i) {
            const double share = static_cast<double>(i) / (k_spheres - 1);
            const Vec3 center =
                transform_point(wrist, capsule.a_hs + share * (capsule.b_hs - capsule.a_hs));
            for (std::size_t m = 0; m < hand_.meshes.size(); ++m, ++cache_index) {
                auto gap = gap_under(hand_.meshes[m], m == 0 ? side_ : 1.0,
                                     {center, capsule.radius_m}, cache_index);
                if (gap) {
                    gap->turn = (center - middle).cross(gap->along);
                    gaps.add_contact(*gap);
                    deepest_m = std::max(deepest_m, -gap->gap_m);
                }
            }
        }
        return deepest_m;
    }

    struct Sphere {
        Vec3 center;
        double radius_m = 0.0;
    };
    // Result of a sphere's last query, in the mesh's frame. Until the sphere has moved by the
    // clearance it cannot penetrate and is not queried again. The next query's radius is at most
    // the distance to `point`: the nearest point cannot be farther away.
    struct CachedQuery {
        Vec3 center = Vec3::Zero();
        Vec3 point = Vec3::Zero();
        double clearance_m = 0.0;
        bool has_point = false;  // a surface was within the query radius
    };

    // Returns the sphere's gap to the nearest point of one mesh. The caller sets PalmGap::turn.
    // `side` is -1 if the sides of the triangles are swapped, else 1.
    std::optional<PalmGap> gap_under(const PlacedMesh& placed, double side, const Sphere& sphere_bs,
                                     std::size_t cache_index) {
        const Sphere sphere = {inverse_transform_point(placed.pose, sphere_bs.center),
                               sphere_bs.radius_m};
        CachedQuery overflow;
        CachedQuery& cached =
            cache_index < query_cache_.size() ? query_cache_[cache_index] : overflow;
        if ((sphere.center - cached.center).squaredNorm() <
            cached.clearance_m * cached.clearance_m) {
            return cached.has_point ? std::optional(gap_over(placed, sphere, cached.point))
                                    : std::nullopt;
        }
        double query_radius_m = std::max(sphere.radius_m, k_max_inside_m);
        if (cached.has_point) {
            constexpr double k_rounding_m = 1e-9;
            query_radius_m =
                std::min(query_radius_m, (sphere.center - cached.point).norm() + k_rounding_m);
        }
        const auto near = placed.mesh->contact_bvh.closest_point(sphere.center, query_radius_m);
        cached = {sphere.center, near ? near->point : Vec3::Zero(),
                  query_radius_m - sphere.radius_m, near.has_value()};
        if (!near) {
            return std::nullopt;
        }
        const PalmGap gap = gap_at(placed, side, *near, sphere);
        cached.clearance_m = std::max(0.0, gap.gap_m);
        return gap;
    }

    // Returns the gap to a known point. `sphere` is in the mesh's frame; its centre is outside the
    // solid.
    static PalmGap gap_over(const PlacedMesh& placed, const Sphere& sphere, const Vec3& point) {
        const Vec3 from_surface = sphere.center - point;
        const double distance_m = from_surface.norm();
        return {placed.pose.rotation * Vec3(from_surface / distance_m), Vec3::Zero(),
                distance_m - sphere.radius_m};
    }

    // Returns the gap to the nearest point `near`. The sphere's centre may be inside the solid.
    // `sphere` is in the mesh's frame.
    static PalmGap gap_at(const PlacedMesh& placed, double side, const TriangleHit& near,
                          const Sphere& sphere) {
        const Vec3 outward = side * placed.mesh->contact.normals[near.triangle];
        const double height_m = outward.dot(sphere.center - near.point);
        // Near an edge, a centre outside the solid can be slightly below the plane of one triangle.
        // So a centre counts as inside only if it is clearly below the plane.
        constexpr double k_min_inside_ratio = 0.5;
        constexpr double k_on_surface_m = 1e-9;
        const bool is_inside = height_m < -k_min_inside_ratio * near.distance_m;
        if (near.distance_m <= k_on_surface_m) {
            return {placed.pose.rotation * outward, Vec3::Zero(), -sphere.radius_m};
        }
        const Vec3 away = (is_inside ? -1.0 : 1.0) / near.distance_m * (sphere.center - near.point);
        return {placed.pose.rotation * away, Vec3::Zero(),
                (is_inside ? -near.distance_m : near.distance_m) - sphere.radius_m};
    }

    // Spheres beyond this number have no cached query and are queried every time.
    static constexpr std::size_t k_max_cached_queries = 96;

    const HandSurroundings& hand_;
    double side_ = 1.0;
    // Links of the open fingers.
    std::array<PalmCapsule, k_finger_count * k_max_links> links_;
    // True: the first link of its finger.
    std::array<bool, k_finger_count* k_max_links> is_first_ = {};
    std::size_t link_count_ = 0;
    double finger_penetration_m_ = 0.0;
    std::array<CachedQuery, k_max_cached_queries> query_cache_;
};

struct PalmMove {
    Vec3 translation_m = Vec3::Zero();
    Vec3 turn_rad = Vec3::Zero();  // rotation vector, about the palm's centre
};

// Finds the smallest move m = (t, r) that makes all gaps non-negative. m counts from the pose that
// clamp_to_limits gave; the gaps are linearised at the move `moved`:
//   minimise |t|^2 + (arm_m |r|)^2   subject to   J_i m >= J_i moved - gap_i
// where J_i = (along_i, turn_i). Solved by projected Gauss-Seidel on the multipliers. If the
// inequalities contradict each other, the result is a compromise.
PalmMove smallest_correction(std::span<const PalmGap> gaps, const PalmMove& moved, double arm_m) {
    constexpr int k_max_sweeps = 24;
    constexpr double k_converged_m = 1e-8;
    struct Row {
        double required_m;      // right-hand side J_i moved - gap_i
        double inverse_weight;  // 1 / (J_i M^-1 J_i^T), with M = diag(1, arm_m^2)
        double multiplier = 0.0;
    };
    const double inverse_inertia = 1.0 / (arm_m * arm_m);
    std::array<Row, PalmGaps::k_max_gaps> rows;  // NOLINT(*-member-init): filled as far as used
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const auto& [along, turn, gap_m] = gaps[i];
        rows[i] = {along.dot(moved.translation_m) + turn.dot(moved.turn_rad) - gap_m,
                   1.0 / (along.squaredNorm() + inverse_inertia * turn.squaredNorm())};
    }
    PalmMove move;
    double change_m = 1.0;
    for (int sweep = 0; sweep < k_max_sweeps && change_m > k_converged_m; ++sweep) {
        change_m = 0.0;
        for (std::size_t i = 0; i < gaps.size(); ++i) {
            const PalmGap& gap = gaps[i];
            Row& row = rows[i];
            const double violation_m =
                row.required_m - gap.along.dot(move.translation_m) - gap.turn.dot(move.turn_rad);
            const double multiplier =
                std::max(0.0, row.multiplier + row.inverse_weight * violation_m);
            const double delta_m = multiplier - row.multiplier;
            move.translation_m += delta_m * gap.along;
            move.turn_rad += delta_m * inverse_inertia * gap.turn;
            row.multiplier = multiplier;
            change_m = std::max(change_m, std::abs(delta_m));
        }
    }
    return move;
}

double size_of(const PalmMove& move, double arm_m) {
    return move.translation_m.norm() + arm_m * move.turn_rad.norm();
}

// True if further iterations would not improve the fit: the palm no longer moves. A clear palm has
// converged earlier, because a smaller correction gains little.
bool is_converged(double deepest_m, double step_m) {
    constexpr double k_stuck_m = 2e-5;
    constexpr double k_converged_m = 2e-4;
    return step_m <= (deepest_m > k_penetration_slop_m ? k_stuck_m : k_converged_m);
}

PalmMove move_between(const Pose& from, const Pose& to, const Vec3& center_hs) {
    return {transform_point(to, center_hs) - transform_point(from, center_hs),
            rotation_to_vector((to.rotation * from.rotation.conjugate()).normalized())};
}

Pose moved_by(const PalmMove& move, const Pose& wrist, const Vec3& center_hs) {
    Pose moved;
    moved.rotation = (rotation_from_vector(move.turn_rad) * wrist.rotation).normalized();
    moved.position =
        transform_point(wrist, center_hs) + move.translation_m - moved.rotation * center_hs;
    return moved;
}

}  // namespace

PalmFit fit_palm(const HandSurroundings& hand, const GripSurface& surface, const PalmTuning& tuning,
                 double max_penetration_m) {
    const Vec3& center_hs = hand.rig->palm_center_hs;
    const double arm_m = std::max(k_min_arm_m, tuning.rotation_arm_m);
    const Pose held = clamp_to_limits(hand, hand.wrist_bs, surface, tuning);
    PalmSpheres palm(hand, surface);
    PalmGaps gaps;
    PalmMove moved;
    Pose wrist = held;
    PalmFit best = {wrist, palm.query(wrist, gaps), palm.finger_penetration_m()};
    double deepest_m = std::max(best.penetration_m, best.finger_penetration_m);
    if (deepest_m <= k_penetration_slop_m) {
        return best;
    }
    double smallest_m = deepest_m;
    double step_m = k_first_step_m;
    for (int i = 0; i < k_max_iterations && !is_converged(deepest_m, step_m); ++i) {
        if (i >= k_min_iterations && smallest_m > max_penetration_m) {
            break;
        }
        // The limits are added last: the solver corrects them last, so that they hold.
        add_limits(hand, surface, wrist, tuning, arm_m, gaps);
        const PalmMove before = moved;
        moved = smallest_correction(gaps.all(), moved, arm_m);
        wrist = moved_by(moved, held, center_hs);
        // The linearised tilt limit is inexact for large turns.
        wrist.rotation =
            clamp_tilt(wrist.rotation, *hand.rig, surface.normal_bs, tuning.max_angle_rad);
        wrist.position =
            transform_point(held, center_hs) + moved.translation_m - wrist.rotation * center_hs;
        moved = move_between(held, wrist, center_hs);
        step_m = size_of(
            {moved.translation_m - before.translation_m, moved.turn_rad - before.turn_rad}, arm_m);
        gaps.clear();
        const double penetration_m = palm.query(wrist, gaps);
        deepest_m = std::max(penetration_m, palm.finger_penetration_m());
        if (deepest_m < smallest_m || deepest_m <= k_penetration_slop_m) {
            smallest_m = deepest_m;
            best = {wrist, penetration_m, palm.finger_penetration_m()};
        }
    }
    return best;
}

}  // namespace handhold
