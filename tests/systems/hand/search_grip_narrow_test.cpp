// Surfaces beside walls, holes and thin plates.
#include <gtest/gtest.h>

#include "components/authored_grip.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"
#include "held_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::search_grip_test {
namespace {

// A slab with outward winding: a palm tracked inside must not be fitted to the bottom from inside.
TEST(SearchGrip, NeverHoldsPalmInsideASolid) {
    constexpr double k_thickness_m = 0.05;
    Mesh slab = test::make_floor_mesh();
    const auto top = static_cast<std::uint32_t>(slab.positions.size());
    for (std::uint32_t i = 0; i < top; ++i) {
        slab.positions.push_back(slab.positions[i] - k_thickness_m * Vec3::UnitY());
    }
    for (std::size_t i = slab.triangles.size(); i-- > 0;) {
        const auto [a, b, c] = slab.triangles[i];
        slab.triangles.push_back({top + a, top + c, top + b});
    }
    const GripMesh mesh = build_grip_mesh(slab);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double deep_m : {0.01, 0.02, 0.03, 0.04}) {
        FittedHand hand(mesh, wrist_with_palm_at(rig, {0.013, -deep_m, 0.007}, Vec3::UnitY()));
        hand.search();
        hand.constrain();
        EXPECT_GE(hand.palm_center_bs().y(), hand.tuning.palm.min_height_m - 1e-9) << deep_m;
        EXPECT_GT(hand.palm_up_bs().y(), 0.9) << deep_m;
    }
}

// Four walls around a hole along y, with outward winding and a groove around the outside.
constexpr double k_hole_x_m = 0.05;
constexpr double k_hole_z_m = 0.07;
constexpr double k_wall_m = 0.047;
constexpr double k_groove_m = 0.014;
constexpr double k_groove_y_m = 0.068;
constexpr double k_frame_y_m = 0.1;

bool is_in_frame(const Vec3& point) {
    const Vec3 at = point.cwiseAbs();
    const double wall_m = at.y() < k_groove_y_m ? k_wall_m - k_groove_m : k_wall_m;
    const bool is_beyond =
        at.x() > k_hole_x_m + wall_m || at.z() > k_hole_z_m + wall_m || at.y() > k_frame_y_m;
    const bool is_in_hole = at.x() < k_hole_x_m && at.z() < k_hole_z_m;
    return !is_beyond && !is_in_hole;
}

// Thickness of the walls at one height.
struct Ring {
    double y;
    double wall_m;
};

// Walls around a rectangular hole along y. The rings run down through the hole and up along the
// outside.
GripMesh make_frame(double half_x_m, double half_z_m, std::span<const Ring> rings) {
    Mesh mesh;
    for (const auto& [y, wall_m] : rings) {
        const double x = half_x_m + wall_m;
        const double z = half_z_m + wall_m;
        mesh.positions.insert(mesh.positions.end(),
                              {{-x, y, -z}, {-x, y, z}, {x, y, z}, {x, y, -z}});
    }
    const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t ring = 0; ring < corners; ring += 4) {
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t a = ring + i;
            const std::uint32_t b = ring + (i + 1) % 4;
            const std::uint32_t c = (b + 4) % corners;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, (a + 4) % corners});
        }
    }
    return build_grip_mesh(mesh);
}

GripMesh make_grooved_frame() {
    constexpr std::array<Ring, 8> k_rings = {{{k_frame_y_m, 0.0},
                                              {-k_frame_y_m, 0.0},
                                              {-k_frame_y_m, k_wall_m},
                                              {-k_groove_y_m, k_wall_m},
                                              {-k_groove_y_m, k_wall_m - k_groove_m},
                                              {k_groove_y_m, k_wall_m - k_groove_m},
                                              {k_groove_y_m, k_wall_m},
                                              {k_frame_y_m, k_wall_m}}};
    return make_frame(k_hole_x_m, k_hole_z_m, k_rings);
}

// A random palm in front of one of the inner walls of a frame.
Pose random_wrist_before_wall(const HandRig& rig, double half_x_m, double half_z_m, double half_y_m,
                              Random& random) {
    const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const bool is_x = random.between(0.0, 1.0) < 0.5;
    const Vec3 inwards = is_x ? Vec3(side * -Vec3::UnitX()) : Vec3(side * -Vec3::UnitZ());
    const double half_m = (is_x ? half_x_m : half_z_m) - random.between(0.002, 0.02);
    const Vec3 along_wall =
        is_x ? Vec3(0.0, half_y_m, half_z_m - 0.02) : Vec3(half_x_m - 0.02, half_y_m, 0.0);
    const Vec3 palm = random.vector(1.0).cwiseProduct(along_wall) - half_m * inwards;
    const Vec3 up = (inwards + random.vector(0.3)).normalized();
    Pose wrist = wrist_with_palm_at(rig, Vec3::Zero(), up);
    wrist.rotation = rotation_about(up, random.between(-3.14, 3.14)) * wrist.rotation;
    wrist.position = palm - wrist.rotation * rig.palm_center_hs;
    return wrist;
}

// The hole is too narrow for straight fingers, which tempts the search to move palms into the
// walls.
TEST(SearchGrip, RarelyHoldsPalmInsideWallsOfNarrowHole) {
    const GripMesh mesh = make_grooved_frame();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(2215);
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
        const Pose wrist = random_wrist_before_wall(rig, k_hole_x_m, k_hole_z_m, 0.06, random);
        FittedHand hand(mesh, wrist);
        hand.search();
        hand.constrain();
        const Vec3 center = hand.palm_center_bs();
        inside += is_in_frame(center) ? 1 : 0;
    }
    EXPECT_LE(inside, 3);  // 13 without enters_solid
}

// Hands in a box without a floor whose walls are thin enough to lie between the palm's spheres:
// walls rarely cross the palm, a digit of the fitted hand, or an open finger beside the palm that
// search_grip chose.
TEST(SearchGrip, RarelyHoldsHandThroughThinWall) {
    constexpr double k_half_m = 0.06;
    constexpr double k_height_m = 0.04;
    constexpr double k_thickness_m = 0.003;
    constexpr double k_max_depth_m = 0.008;
    constexpr std::array<Ring, 4> k_rings = {{{k_height_m, 0.0},
                                              {-k_height_m, 0.0},
                                              {-k_height_m, k_thickness_m},
                                              {k_height_m, k_thickness_m}}};
    const GripMesh mesh = make_frame(k_half_m, k_half_m, k_rings);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(2216);
    int palms_through = 0;
    int fingers_through = 0;
    int open_fingers_through = 0;
    for (int i = 0; i < 300; ++i) {
        FittedHand hand(mesh,
                        random_wrist_before_wall(rig, k_half_m, k_half_m, k_height_m, random));
        hand.frame(test::k_unlimited_s);
        palms_through += palm_penetration_m(hand, hand.shown_bs()) > k_max_depth_m ? 1 : 0;
        fingers_through += is_digit_crossed(hand) ? 1 : 0;
        open_fingers_through += is_open_finger_crossed(hand) ? 1 : 0;
    }
    EXPECT_LE(palms_through, 3);     // 1 %; 23 hands without the crossing checks
    EXPECT_LE(fingers_through, 12);  // 4 %; 72 hands without finger_crossing_depth_m
    EXPECT_LE(open_fingers_through, 12);
}
}  // namespace
}  // namespace handhold::search_grip_test
