#include "systems/hand/shared/palm_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/authored_grip.hpp"
#include "engine/geometry/surface_crossings.hpp"
#include "systems/hand/shared/outside_surfaces.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr double k_crossing_m = 1e-6;  // surfaces closer together than this count as one crossing

PalmFrame palm_in(const Pose& frame, const HandRig& rig, const Pose& wrist_bs) {
    const Pose wrist = inverse(frame) * wrist_bs;
    return {transform_point(wrist, rig.palm_center_hs), wrist.rotation * -rig.palm_normal_hs};
}

// Returns the mean normal, as a unit vector, of the triangles within `radius_m` of the point that
// face `outward`, weighted by the area that is seen from there: sides of a beam seen edge-on count
// nothing, so that the palm does not tilt towards one of them.
Vec3 mean_normal(const GripMesh& mesh, const Vec3& point, const Vec3& triangle_normal,
                 const Vec3& outward, double radius_m) {
    // Limits the weight of a triangle that extends far outside the sphere.
    const double max_area_m2 = 2.0 * std::numbers::pi * radius_m * radius_m;
    const Vec3 sum = mesh.contact_bvh.areas_in_sphere(point, radius_m, outward, max_area_m2);
    const double length = sum.norm();
    return length > 1e-12 ? Vec3(sum / length) : triangle_normal;
}

// Returns 1 if a path in `direction` enters a solid at this surface point, and -1 if it leaves one.
// Returns 0 if it does both: between two touching solids, through a two-sided sheet, along an edge.
int crossing_sign(const GripMesh& mesh, const Vec3& point, const Vec3& direction) {
    bool enters = false;
    bool leaves = false;
    mesh.contact_bvh.visit_in_sphere(point, k_crossing_m, [&](std::uint32_t triangle) {
        const double along = mesh.contact.normals[triangle].dot(direction);
        enters = enters || along < 0.0;
        leaves = leaves || along > 0.0;
    });
    return (enters ? 1 : 0) - (leaves ? 1 : 0);
}

}  // namespace

PalmFitter::PalmFitter(const HandSurroundings& hand, const Pose& wrist_bs, const PalmTuning& tuning)
    : hand_(hand),
      placed_(hand.meshes.front()),
      palm_(palm_in(placed_.pose, *hand.rig, wrist_bs)),
      tuning_(tuning) {}

GripSurface PalmFitter::surface_at(const Candidate& candidate) const {
    const GripMesh& mesh = *placed_.mesh;
    const auto on_contact = mesh.contact_bvh.closest_point(candidate.point, tuning_.reach_m);
    const Vec3 point = on_contact ? on_contact->point : candidate.point;
    // The mean normal includes only triangles that, like this one, face the palm (side 1) or face
    // away from it (side -1).
    const Vec3 winding_normal = mesh.search.normals[candidate.triangle];
    const double side = winding_normal.dot(palm_.up) < 0.0 ? -1.0 : 1.0;
    GripSurface surface;
    surface.body = hand_.body;
    surface.wrist_bs = hand_.wrist_bs;
    surface.surroundings_signature = hand_.search_signature;
    surface.triangle = candidate.triangle;
    surface.point_bs = transform_point(placed_.pose, point);
    surface.normal_bs =
        placed_.pose.rotation * Vec3(side * mean_normal(mesh, point, winding_normal,
                                                        side * palm_.up, tuning_.normal_radius_m));
    return surface;
}

FittedPalm PalmFitter::fit(const Candidate& candidate, double max_penetration_m) const {
    FittedPalm held;
    held.surface = surface_at(candidate);
    const PalmFit fit = fit_palm(hand_, held.surface, tuning_, max_penetration_m);
    held.surface.fitted_wrist_bs = fit.wrist_bs;
    held.penetration_m = fit.penetration_m;
    held.finger_penetration_m = fit.finger_penetration_m;
    const GripSync sync = grip_sync(hand_.wrist_bs, fit.wrist_bs, hand_.rig->palm_center_hs);
    held.sync_m = sync.palm_m + tuning_.tilt_cost_m_per_rad * sync.turn_rad;
    return held;
}

bool PalmFitter::is_backface(const Candidate& candidate) const {
    return placed_.mesh->search.normals[candidate.triangle].dot(palm_.up) < 0.0;
}

bool PalmFitter::is_inside(const Candidate& candidate) const {
    constexpr double k_ray_start_m = 1e-3;
    constexpr double k_ray_m = 1.0;
    const GripMesh& mesh = *placed_.mesh;
    const Vec3 out = -mesh.search.normals[candidate.triangle];
    const auto hit = mesh.search_bvh.cast_ray(candidate.point + k_ray_start_m * out,
                                              candidate.point + k_ray_m * out);
    return hit && mesh.search.normals[hit->triangle].dot(out) > 0.0;
}

bool PalmFitter::enters_solid(const FittedPalm& held) const {
    constexpr int k_max_crossed = 32;  // a path with more crossings counts as entering
    const Vec3 to = palm_in(placed_.pose, *hand_.rig, held.surface.fitted_wrist_bs).center;
    const Vec3 direction = (to - palm_.center).normalized();
    Vec3 from = palm_.center;
    int entered = 0;
    for (int i = 0; (to - from).dot(direction) > k_crossing_m; ++i) {
        const auto hit = placed_.mesh->contact_bvh.cast_ray(from, to);
        if (!hit) {
            break;
        }
        if (i == k_max_crossed) {
            return true;
        }
        entered += crossing_sign(*placed_.mesh, hit->point, direction);
        from = hit->point + 2.0 * k_crossing_m * direction;
    }
    return entered > 0;
}

bool PalmFitter::is_out_of_sight(const FittedPalm& held) const {
    if (!hand_.eye_bs) {
        return false;
    }
    const Pose& wrist_bs = held.surface.fitted_wrist_bs;
    const Vec3 to = palm_in(placed_.pose, *hand_.rig, wrist_bs).center;
    const bool crosses = crosses_oddly(placed_.mesh->contact_bvh, palm_.center, to);
    const bool was_behind =
        is_behind(placed_, *hand_.eye_bs, transform_point(placed_.pose, palm_.center));
    const bool is_on_the_far_side = crosses != was_behind;
    return is_on_the_far_side && (crosses || are_tips_behind(wrist_bs));
}

bool PalmFitter::are_tips_behind(const Pose& wrist_bs) const {
    return std::ranges::all_of(hand_.rig->fingers, [&](const FingerRig& finger) {
        const auto points_hs = finger_points(finger, coupled_angles(finger, 0.0));
        const Vec3 tip_bs = transform_point(wrist_bs, points_hs[finger.link_count]);
        return finger.name == FingerName::thumb || is_behind(placed_, *hand_.eye_bs, tip_bs);
    });
}

double PalmFitter::crossing_depth_m(const FittedPalm& held) const {
    double deepest_m = 0.0;
    for (const PalmCapsule& capsule : hand_.rig->palm) {
        deepest_m = std::max(deepest_m, crossing_depth_of(capsule, held.surface.fitted_wrist_bs));
    }
    return deepest_m;
}

double PalmFitter::finger_crossing_depth_m(const FittedPalm& held) const {
    double deepest_m = 0.0;
    for (const FingerRig& finger : hand_.rig->fingers) {
        const auto points = finger_points(finger, coupled_angles(finger, 0.0));
        for (std::size_t i = 0; finger.name != FingerName::thumb && i < finger.link_count; ++i) {
            const PalmCapsule link = {points[i], points[i + 1], finger.radius_m[i]};
            deepest_m = std::max(deepest_m, crossing_depth_of(link, held.surface.fitted_wrist_bs));
        }
    }
    return deepest_m;
}

double PalmFitter::crossing_depth_of(const PalmCapsule& capsule, const Pose& wrist_bs) const {
    double deepest_m = 0.0;
    for (const PlacedMesh& placed : hand_.meshes) {
        const TriangleBvh& bvh = placed.mesh->contact_bvh;
        const Pose wrist = inverse(placed.pose) * wrist_bs;
        const Vec3 a = transform_point(wrist, capsule.a_hs);
        const Vec3 b = transform_point(wrist, capsule.b_hs);
        const auto from_a = bvh.cast_ray(a, b);
        const auto from_b = from_a ? bvh.cast_ray(b, a) : std::nullopt;
        for (const auto& hit : {from_a, from_b}) {
            if (hit) {
                const double end_m = std::min((hit->point - a).norm(), (hit->point - b).norm());
                deepest_m = std::max(deepest_m, capsule.radius_m + end_m);
            }
        }
    }
    return deepest_m;
}

std::optional<PalmFitter::Candidate> PalmFitter::candidate_near_last(
    const SurfaceSearch& searcher, const GripSurface& last) const {
    return last.triangle == GripSurface::k_none
               ? std::nullopt
               : searcher.cheapest_near(inverse_transform_point(placed_.pose, last.point_bs),
                                        last.triangle);
}

}  // namespace handhold
