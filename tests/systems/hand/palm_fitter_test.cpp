#include "systems/hand/shared/palm_fitter.hpp"

#include <gtest/gtest.h>

#include "fitted_hand.hpp"

namespace handhold::palm_fitter_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::wrist_with_palm_at;

// Adds a box with outward winding to a mesh.
void add_box(const Vec3& middle, const Vec3& half, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double y : {-1.0, 1.0}) {
        for (const auto& [x, z] : {std::array{-1.0, -1.0}, std::array{-1.0, 1.0},
                                   std::array{1.0, 1.0}, std::array{1.0, -1.0}}) {
            mesh.positions.push_back(middle + half.cwiseProduct(Vec3(x, y, z)));
        }
    }
    constexpr std::array<std::array<std::uint32_t, 4>, 6> k_sides = {
        {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}, {3, 2, 1, 0}}};
    for (const auto& [a, b, c, d] : k_sides) {
        mesh.triangles.push_back({first + a, first + b, first + c});
        mesh.triangles.push_back({first + a, first + c, first + d});
    }
}

// PalmFitter::enters_solid for a palm tracked at one point and fitted at another.
bool enters_solid(const Mesh& mesh, const Vec3& tracked, const Vec3& held) {
    const GripMesh grip = build_grip_mesh(mesh);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Tuning tuning;
    FittedHand hand(grip, wrist_with_palm_at(rig, tracked, Vec3::UnitY()));
    const HandSurroundings& surroundings = hand.hands.front();
    const PalmFitter fitter(surroundings, surroundings.wrist_bs, tuning.palm);
    FittedPalm palm;
    palm.surface.fitted_wrist_bs = wrist_with_palm_at(rig, held, Vec3::UnitY());
    return fitter.enters_solid(palm);
}

TEST(PalmFitter, EntersSolidOnlyIfItsPathEndsInside) {
    const Vec3 above(0.011, 0.2, 0.017);
    const auto below = [&](double down_m) -> Vec3 { return above - Vec3(0.003, down_m, 0.001); };
    const Vec3 half(0.1, 0.05, 0.1);
    Mesh box;
    add_box(Vec3::Zero(), half, box);
    EXPECT_FALSE(enters_solid(box, above, above));
    EXPECT_FALSE(enters_solid(box, above, below(0.1)));  // still above the box
    EXPECT_TRUE(enters_solid(box, above, below(0.2)));   // inside
    EXPECT_FALSE(enters_solid(box, above, below(0.3)));  // through the box
    EXPECT_FALSE(enters_solid(box, below(0.2), above));  // leaves the box
    EXPECT_FALSE(enters_solid(box, below(0.2), below(0.21)));

    Mesh stack = box;  // with a second box below, face to face
    add_box(Vec3(0.0, -0.1, 0.0), half, stack);
    EXPECT_TRUE(enters_solid(stack, above, below(0.2)));
    EXPECT_TRUE(enters_solid(stack, above, below(0.3)));
    EXPECT_FALSE(enters_solid(stack, above, below(0.4)));

    Mesh sheet;  // two-sided
    sheet.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
    EXPECT_FALSE(enters_solid(sheet, above, below(0.3)));
    EXPECT_FALSE(enters_solid(sheet, below(0.3), above));

    Mesh slats;
    for (int i = 0; i < 6; ++i) {
        add_box(Vec3(0.0, -0.02 * i, 0.0), Vec3(0.1, 0.004, 0.1), slats);
    }
    EXPECT_TRUE(enters_solid(slats, above, below(0.28)));   // inside the fifth slat
    EXPECT_FALSE(enters_solid(slats, above, below(0.29)));  // between the fifth and the sixth
}

// PalmFitter::crossing_depth_m for a palm fitted at `held` among the meshes.
double crossing_depth_m(std::vector<PlacedMesh> meshes, const Vec3& held) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Tuning tuning;
    FittedPalm palm;
    palm.surface.fitted_wrist_bs = wrist_with_palm_at(rig, held, Vec3::UnitY());
    FittedHand hand(*meshes.front().mesh, palm.surface.fitted_wrist_bs);
    HandSurroundings& surroundings = hand.hands.front();
    surroundings.meshes = std::move(meshes);
    return PalmFitter(surroundings, surroundings.wrist_bs, tuning.palm).crossing_depth_m(palm);
}

TEST(PalmFitter, CrossingDepthIsRadiusPlusDistanceToTheNearerEnd) {
    Mesh floor;
    add_box(Vec3(0.0, -0.05, 0.0), Vec3(0.3, 0.05, 0.3), floor);
    const GripMesh floor_grip = build_grip_mesh(floor);
    EXPECT_EQ(crossing_depth_m({{&floor_grip, {}}}, {0.0, 0.05, 0.0}), 0.0);
    EXPECT_EQ(crossing_depth_m({{&floor_grip, {}}}, {0.0, 0.012, 0.0}),
              0.0);  // penetrates, but no axis is crossed

    // A thin wall across the middle of the longest capsule, in its own frame.
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const auto length_m = [](const PalmCapsule& capsule) {
        return (capsule.b_hs - capsule.a_hs).norm();
    };
    PalmCapsule longest = rig.palm.front();
    for (const PalmCapsule& capsule : rig.palm) {
        longest = length_m(capsule) > length_m(longest) ? capsule : longest;
    }
    constexpr double k_half_thickness_m = 1e-3;
    const Vec3 along = (longest.b_hs - longest.a_hs).normalized();
    const Vec3 held(0.0, 0.05, 0.0);
    const Vec3 middle_bs = 0.5 * (longest.a_hs + longest.b_hs) - rig.palm_center_hs + held;
    const Pose placed = {middle_bs, rotation_between(Vec3::UnitX(), along)};
    Mesh wall;
    add_box(Vec3::Zero(), Vec3(k_half_thickness_m, 0.2, 0.2), wall);
    const GripMesh wall_grip = build_grip_mesh(wall);
    const double expected_m = longest.radius_m + 0.5 * length_m(longest) - k_half_thickness_m;
    EXPECT_NEAR(crossing_depth_m({{&floor_grip, {}}, {&wall_grip, placed}}, held), expected_m,
                1e-4);
    EXPECT_NEAR(crossing_depth_m({{&wall_grip, placed}, {&floor_grip, {}}}, held), expected_m,
                1e-4);
}

}  // namespace
}  // namespace handhold::palm_fitter_test
