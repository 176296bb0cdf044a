#include "systems/hand/shared/buried_palm.hpp"

#include <algorithm>
#include <optional>

#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold {
namespace {

struct Exit {
    Vec3 point;
    Vec3 normal;           // unit, out of the solid
    double depth_m = 0.0;  // depth of the point that is inside
};

// Nullopt: the point is not inside a solid.
std::optional<Exit> exit_of(const GripMesh& mesh, const Vec3& inside, double reach_m) {
    constexpr double k_same_place_m = 1e-6;
    constexpr double k_thickest_m = 1.0;
    const auto near = mesh.contact_bvh.closest_point(inside, reach_m);
    const double depth_m = near ? (inside - near->point).norm() : 0.0;
    if (depth_m < k_same_place_m) {
        return std::nullopt;
    }
    bool is_outside = false;
    mesh.contact_bvh.visit_in_sphere(near->point, k_same_place_m, [&](std::uint32_t triangle) {
        is_outside |= (inside - near->point).dot(mesh.contact.normals[triangle]) >= 0.0;
    });
    const Vec3 inward = (inside - near->point) / depth_m;
    const auto far = mesh.contact_bvh.cast_ray(inside, inside + k_thickest_m * inward);
    const bool leaves = far && mesh.contact.normals[far->triangle].dot(inward) > 0.0;
    return is_outside || !leaves
               ? std::nullopt
               : std::optional(Exit{near->point, mesh.contact.normals[near->triangle], depth_m});
}

// Calls visit(center_hs, radius_m) for the ends of all capsules of a fist.
template <typename Visit>
void visit_fist(const HandRig& rig, const Visit& visit) {
    for (const PalmCapsule& capsule : rig.palm) {
        visit(capsule.a_hs, capsule.radius_m);
        visit(capsule.b_hs, capsule.radius_m);
    }
    for (const FingerRig& finger : rig.fingers) {
        const auto points = finger_points(finger, coupled_angles(finger, k_fist_curl));
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            visit(points[i], finger.radius_m[i]);
            visit(points[i + 1], finger.radius_m[i]);
        }
    }
}

// Of the deepest capsule end of a fist.
std::optional<Exit> exit_of_fist(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                                 double reach_m) {
    std::optional<Exit> deepest;
    visit_fist(rig, [&](const Vec3& center_hs, double /*radius_m*/) {
        const auto exit = exit_of(mesh, transform_point(wrist, center_hs), reach_m);
        if (exit && (!deepest || exit->depth_m > deepest->depth_m)) {
            deepest = exit;
        }
    });
    return deepest;
}

// How far a fist reaches behind the plane.
double depth_m(const HandRig& rig, const Pose& wrist, const Exit& plane) {
    double deepest_m = 0.0;
    visit_fist(rig, [&](const Vec3& center_hs, double radius_m) {
        const Vec3 offset = transform_point(wrist, center_hs) - plane.point;
        deepest_m = std::max(deepest_m, radius_m - offset.dot(plane.normal));
    });
    return deepest_m;
}

}  // namespace

Pose wrist_outside_bs(const HandSurroundings& hand, const PalmTuning& tuning) {
    const PlacedMesh& placed = hand.meshes.front();
    Pose wrist = inverse(placed.pose) * hand.wrist_bs;
    constexpr int k_most_faces = 3;  // faces that meet in a corner
    bool is_moved = false;
    for (int i = 0; i < k_most_faces; ++i) {
        const auto exit = exit_of_fist(*placed.mesh, *hand.rig, wrist, tuning.reach_m);
        if (!exit) {
            break;
        }
        wrist.position += depth_m(*hand.rig, wrist, *exit) * exit->normal;
        is_moved = true;
    }
    return is_moved ? placed.pose * wrist : hand.wrist_bs;
}

}  // namespace handhold
