#include "systems/hand/shared/hand_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/surface_crossings.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

// Largest distance between spheres of one link, of links up to k_max_pieces times this.
constexpr double k_spacing_m = 0.018;
constexpr double k_extra_gap_m = 0.005;  // links farther away need no extra sphere
// Centres deeper inside a solid have no gap, or count as outside unless they were inside at their
// last search.
constexpr double k_max_depth_inside_m = 0.03;

double query_radius_m(const HandSphere& sphere) {
    const double reach_m = sphere.is_tip ? k_tip_reach_m : k_sphere_reach_m;
    return std::max(sphere.radius_m + reach_m, k_max_depth_inside_m);
}

std::size_t group_of(const HandSphere& sphere) {
    return sphere.finger == HandSphere::k_palm ? k_finger_count
                                               : static_cast<std::size_t>(sphere.finger);
}

Vec3 center_of(const HandSphere& sphere, const HandPose& pose, const HandLinkFrames& frames) {
    const Pose& frame = sphere.finger == HandSphere::k_palm
                            ? pose.wrist_bs
                            : frames[static_cast<std::size_t>(sphere.finger)][sphere.link];
    return transform_point(frame, sphere.center_ls);
}

const HandSphere* nearest_of(std::span<const HandSphere> spheres) {
    const HandSphere* nearest = nullptr;
    for (const HandSphere& sphere : spheres) {
        const bool counts = sphere.has_gap && !is_knuckle(sphere);
        if (counts && (nearest == nullptr || sphere.gap_m < nearest->gap_m)) {
            nearest = &sphere;
        }
    }
    return nearest;
}

}  // namespace

bool is_knuckle(const HandSphere& sphere) {
    return sphere.finger != HandSphere::k_palm && sphere.link == 0 && sphere.center_ls.isZero();
}

HandLinkFrames link_frames(const HandRig& rig, const HandPose& pose) {
    HandLinkFrames frames;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const auto frames_hs = finger_link_frames(rig.fingers[f], pose.fingers[f]);
        for (std::size_t link = 0; link < rig.fingers[f].link_count; ++link) {
            frames[f][link] = pose.wrist_bs * frames_hs[link];
        }
    }
    return frames;
}

HandSpheres::HandSpheres(const HandSurroundings& hand, const GripSurface& surface,
                         const std::array<bool, k_finger_count>& is_clear)
    : hand_(hand), is_clear_(is_clear) {
    HH_CHECK(hand.rig->palm.size() <= k_max_palm_capsules, "too many palm capsules",
             hand.rig->palm.size());
    const PlacedMesh& placed = hand.meshes.front();
    const Vec3 wound = placed.pose.rotation * placed.mesh->search.normals[surface.triangle];
    winding_ = wound.dot(surface.normal_bs) < 0.0 ? -1.0 : 1.0;
    // Each capsule's extra sphere comes after its others.
    for (std::size_t i = 0; i < hand.rig->palm.size(); ++i) {
        const PalmCapsule& capsule = hand.rig->palm[i];
        HandSphere sphere;
        sphere.link = i;
        sphere.radius_m = capsule.radius_m;
        for (const double share : {0.0, 0.5, 1.0}) {
            sphere.center_ls = capsule.a_hs + share * (capsule.b_hs - capsule.a_hs);
            add(sphere);
        }
        sphere.is_extra = true;
        add(sphere);
    }
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        first_[f] = count_;
        for (std::size_t link = 0; link < finger.link_count; ++link) {
            HandSphere sphere;
            sphere.finger = static_cast<std::int32_t>(f);
            sphere.link = link;
            sphere.radius_m = finger.radius_m[link];
            const int pieces = std::clamp(
                static_cast<int>(std::ceil(finger.length_m[link] / k_spacing_m)), 1, k_max_pieces);
            // A later link's first sphere is the previous link's last.
            for (int i = link == 0 ? 0 : 1; i <= pieces; ++i) {
                sphere.center_ls = Vec3(0.0, 0.0, -finger.length_m[link] * i / pieces);
                sphere.is_tip = link + 1 == finger.link_count && i == pieces;
                add(sphere);
            }
            sphere.is_tip = false;
            sphere.is_extra = true;
            add(sphere);
        }
    }
    std::fill(first_.begin() + static_cast<std::ptrdiff_t>(hand.rig->fingers.size()), first_.end(),
              count_);
}

std::array<double, k_finger_count + 1> HandSpheres::keep_gaps_m(
    std::span<const HandSphere> spheres) const {
    std::array<double, k_finger_count + 1> nearest_m;
    nearest_m.fill(std::numeric_limits<double>::infinity());
    for (const HandSphere& sphere : spheres) {
        if (!sphere.is_extra && is_queried_ && !is_knuckle(sphere)) {
            const Vec3 moved = sphere.center - sphere.searched_center;
            double& least_m = nearest_m[group_of(sphere)];
            least_m =
                std::min(least_m, std::max(sphere.searched_gap_m + moved.norm(), k_extra_gap_m));
        }
    }
    return nearest_m;
}

void HandSpheres::query(const HandPose& pose, const HandLinkFrames& frames) {
    query(std::span(spheres_).first(count_), pose, frames);
    is_queried_ = true;
}

void HandSpheres::query_digit(std::size_t finger, const HandPose& pose,
                              const HandLinkFrames& frames) {
    query(std::span(spheres_).subspan(first_[finger], first_[finger + 1] - first_[finger]), pose,
          frames);
}

void HandSpheres::query(std::span<HandSphere> spheres, const HandPose& pose,
                        const HandLinkFrames& frames) {
    const HandSphere* nearest = nullptr;   // sphere of the present capsule with the smallest gap
    const HandSphere* previous = nullptr;  // sphere that was searched last
    for (HandSphere& sphere : spheres) {
        sphere.center = center_of(sphere, pose, frames);
    }
    const auto keep_m = keep_gaps_m(spheres);
    for (HandSphere& sphere : spheres) {
        if (sphere.is_extra) {
            if (is_queried_ && keeps_gap(sphere)) {
                nearest = nullptr;
                continue;
            }
            sphere.has_gap = false;
            if (nearest != nullptr && nearest->gap_m < k_extra_gap_m) {
                query_extra(*nearest, sphere, pose, frames);
            }
            nearest = nullptr;
            continue;
        }
        const Vec3 moved = sphere.center - sphere.searched_center;
        if (is_queried_ && sphere.has_gap && !sphere.is_tip &&
            sphere.searched_gap_m - moved.norm() > keep_m[group_of(sphere)]) {
            sphere.gap_m = sphere.searched_gap_m + sphere.away.dot(moved);
            continue;
        }
        if (is_queried_ && keeps_gap(sphere)) {
            if (nearest == nullptr || sphere.gap_m < nearest->gap_m) {
                nearest = &sphere;
            }
            continue;
        }
        query_sphere(sphere, previous, !is_queried_);
        previous = &sphere;
        if (sphere.has_gap && (nearest == nullptr || sphere.gap_m < nearest->gap_m)) {
            nearest = &sphere;
        }
    }
}

// If the centre is still near the place of the last search, corrects the sphere's gap by the
// movement of its centre and returns true.
bool HandSpheres::keeps_gap(HandSphere& sphere) {
    const Vec3 moved = sphere.center - sphere.searched_center;
    if (!sphere.has_gap || moved.norm() > k_keep_travel_m) {
        return false;
    }
    sphere.gap_m = sphere.searched_gap_m + sphere.away.dot(moved);
    return true;
}

// Puts the extra sphere where the axis is nearest to the surface point of the capsule's nearest
// sphere.
void HandSpheres::query_extra(const HandSphere& nearest, HandSphere& extra, const HandPose& pose,
                              const HandLinkFrames& frames) {
    constexpr double k_same_m = 1e-3;
    const Vec3 point = nearest.center - (nearest.gap_m + nearest.radius_m) * nearest.away;
    if (extra.finger == HandSphere::k_palm) {
        const PalmCapsule& capsule = hand_.rig->palm[extra.link];
        extra.center_ls = closest_on_segment(inverse_transform_point(pose.wrist_bs, point),
                                             capsule.a_hs, capsule.b_hs);
    } else {
        const auto f = static_cast<std::size_t>(extra.finger);
        const double length_m = hand_.rig->fingers[f].length_m[extra.link];
        const Vec3 point_ls = inverse_transform_point(frames[f][extra.link], point);
        extra.center_ls = Vec3(0.0, 0.0, std::clamp(point_ls.z(), -length_m, 0.0));
    }
    extra.center = center_of(extra, pose, frames);
    if ((extra.center - nearest.center).norm() < k_same_m) {
        return;
    }
    extra.searched_center = nearest.searched_center;
    extra.signed_m = nearest.signed_m;
    query_sphere(extra, &nearest, false);
}

// Side of the gripped mesh on which the centre is: 1 outside, -1 inside. `is_below`: it is clearly
// below its nearest triangle. Reads the sphere's last search.
double HandSpheres::side_of_gripped(const HandSphere& sphere, bool is_below, bool is_first) const {
    if (is_first) {
        const bool is_clear = sphere.finger != HandSphere::k_palm &&
                              is_clear_[static_cast<std::size_t>(sphere.finger)];
        return is_below && !is_clear ? -1.0 : 1.0;
    }
    const double side = sphere.signed_m < 0.0 ? -1.0 : 1.0;
    if ((sphere.center - sphere.searched_center).norm() < std::abs(sphere.signed_m)) {
        return side;  // too short a path to reach the surface
    }
    const PlacedMesh& placed = hand_.meshes.front();
    return crosses_oddly(placed.mesh->contact_bvh,
                         inverse_transform_point(placed.pose, sphere.searched_center),
                         inverse_transform_point(placed.pose, sphere.center))
               ? -side
               : side;
}

// Returns `radius_m`, or the distance to the triangle that the sphere found last if that is less: a
// bound of the nearest triangle's distance.
double HandSpheres::bound_m(const Vec3& center_ms, double radius_m,
                            const HandSphere& sphere) const {
    constexpr double k_slack_m = 1e-9;
    const SurfaceGraph& graph = hand_.meshes.front().mesh->contact;
    if (sphere.triangle == k_no_triangle) {
        return radius_m;
    }
    const Vec3 on_triangle = closest_on_triangle(center_ms, corners_of(graph, sphere.triangle));
    return std::min(radius_m, (on_triangle - center_ms).norm() + k_slack_m);
}

void HandSpheres::query_sphere(HandSphere& sphere, const HandSphere* near_sphere, bool is_first) {
    // A centre at least this far below its nearest triangle's plane is inside. Beyond an edge, a
    // centre outside the solid can be slightly below one triangle's plane.
    constexpr double k_min_inside_ratio = 0.5;
    constexpr double k_on_surface_m = 1e-9;
    const double radius_m = query_radius_m(sphere);
    double signed_m = radius_m;
    sphere.has_gap = false;
    sphere.gap_m = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < hand_.meshes.size(); ++m) {
        const PlacedMesh& placed = hand_.meshes[m];
        const Vec3 center_ms = inverse_transform_point(placed.pose, sphere.center);
        double within_m = radius_m;
        if (m == 0) {
            within_m = bound_m(center_ms, within_m, sphere);
            if (near_sphere != nullptr && near_sphere->triangle != sphere.triangle) {
                within_m = bound_m(center_ms, within_m, *near_sphere);
            }
            sphere.triangle = k_no_triangle;
        }
        const auto near = placed.mesh->contact_bvh.closest_point(center_ms, within_m);
        if (!near) {
            continue;
        }
        const Vec3 offset = sphere.center - transform_point(placed.pose, near->point);
        const Vec3 outward =
            placed.pose.rotation *
            Vec3((m == 0 ? winding_ : 1.0) * placed.mesh->contact.normals[near->triangle]);
        const bool is_below = near->distance_m < k_max_depth_inside_m &&
                              outward.dot(offset) < -k_min_inside_ratio * near->distance_m;
        double side = is_below ? -1.0 : 1.0;
        if (m == 0) {
            side = side_of_gripped(sphere, is_below, is_first);
            signed_m = side * near->distance_m;
            sphere.triangle = near->triangle;
        }
        const double gap_m = side * near->distance_m - sphere.radius_m;
        if (gap_m < sphere.gap_m) {
            sphere.gap_m = gap_m;
            sphere.has_gap = true;
            sphere.away = near->distance_m > k_on_surface_m ? Vec3(side / near->distance_m * offset)
                                                            : outward;
        }
    }
    sphere.searched_center = sphere.center;
    sphere.searched_gap_m = sphere.gap_m;
    sphere.signed_m = signed_m;
}

const HandSphere* HandSpheres::nearest(std::size_t finger) const {
    return nearest_of(of_digit(finger));
}

const HandSphere* HandSpheres::nearest_of_palm() const {
    return nearest_of(all().first(first_[0]));
}

double HandSpheres::penetration_m() const {
    double depth_m = 0.0;
    for (const HandSphere& sphere : all()) {
        depth_m = std::max(depth_m, sphere.has_gap ? -sphere.gap_m : 0.0);
    }
    return depth_m;
}

double HandSpheres::gap_m(std::size_t finger) const {
    double gap_m = std::numeric_limits<double>::infinity();
    for (const HandSphere& sphere : of_digit(finger)) {
        if (sphere.has_gap) {
            gap_m = std::min(gap_m, sphere.gap_m);
        }
    }
    return gap_m;
}

}  // namespace handhold
