#include "systems/hand/shared/finger_chain.hpp"

#include <algorithm>

#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

// seed_under_palm and seed_near_finger return start points of searches, in the mesh's frame.
GraphPoint seed_under_palm(const PlacedMesh& placed, const GripSurface& surface) {
    const SurfaceGraph& graph = placed.mesh->search;
    if (surface.triangle >= graph.triangles.size()) {
        return {};
    }
    const Vec3 point = inverse_transform_point(placed.pose, surface.point_bs);
    return {surface.triangle, closest_on_triangle(point, corners_of(graph, surface.triangle))};
}

GraphPoint seed_near_finger(const PlacedMesh& placed, const HingeChain& chain) {
    const double radius_m = reach_m(chain);
    // The middle of the half-closed finger, in the base's frame.
    const Vec3 half_closed_middle(0.0, -0.2 * radius_m, -0.4 * radius_m);
    const Vec3 middle = transform_point(inverse(placed.pose) * chain.base, half_closed_middle);
    const auto near = placed.mesh->search_bvh.closest_point(middle, radius_m);
    return near ? GraphPoint{near->triangle, near->point} : GraphPoint{};
}

}  // namespace

HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist) {
    HingeChain chain;
    Pose base = finger.base_hs;
    base.rotation = rotation_about(finger.opposition_axis_hs, opposition_rad) * base.rotation;
    chain.base = wrist * base;
    chain.link_count = finger.link_count;
    chain.length_m = finger.length_m;
    chain.radius_m = finger.radius_m;
    chain.open_rad = finger.lower_rad;
    chain.closed_rad = finger.upper_rad;
    chain.rest_rad = finger.rest_rad;
    return chain;
}

double clear_depth_m(const FingerRig& finger) {
    return *std::min_element(
        finger.radius_m.begin(),
        finger.radius_m.begin() + static_cast<std::ptrdiff_t>(finger.link_count));
}

ChainFitSettings chain_settings(const FingerTuning& tuning) {
    ChainFitSettings settings;
    settings.plane_offset = tuning.plane_offset;
    settings.search_depth_m = tuning.search_depth_m;
    settings.open_depth_m = tuning.open_depth_m;
    settings.open_step_rad = tuning.open_step_rad;
    settings.open_steps = tuning.open_steps;
    return settings;
}

Pose held_wrist_bs(const HandSurroundings& hand, const PalmOffset& offset) {
    return hand.wrist_bs * Pose{offset.held_m, rotation_from_vector(offset.held_turn_rad)};
}

ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     const HingeChain& chain) {
    const PlacedMesh& placed = hand.meshes.front();
    return {seed_under_palm(placed, surface), seed_near_finger(placed, chain)};
}

double hand_travel_m(const Pose& from, const Pose& to) {
    const Pose moved = inverse(from) * to;
    return moved.position.norm() + k_travel_arm_m * rotation_to_vector(moved.rotation).norm();
}

bool touches(const ChainFit& fit) {
    return fit.contact_link != DiscClosure::k_none && fit.fallback != ChainFallback::rest_pose;
}

}  // namespace handhold
