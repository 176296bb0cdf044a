#include "components/palm_holder.hpp"

#include <gtest/gtest.h>

#include "fitted_hand.hpp"

namespace handhold::palm_holder_test {
namespace {

using test::FittedHand;
using test::wrist_with_palm_at;

// Adds a box to a mesh, wound outwards.
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

// Whether a palm that is tracked at one place goes into something to be held at another.
bool goes_in(const Mesh& mesh, const Vec3& tracked, const Vec3& held) {
    const GripMesh grip = build_grip_mesh(mesh);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Tuning tuning;
    FittedHand hand(grip, wrist_with_palm_at(rig, tracked, Vec3::UnitY()));
    const HandSurroundings& surroundings = hand.hands.front();
    const PalmHolder holder(surroundings, surroundings.wrist_bs, test::k_at_once_s, tuning.palm);
    HeldPalm palm;
    palm.surface.held_bs = wrist_with_palm_at(rig, held, Vec3::UnitY());
    return holder.is_entering(palm);
}

TEST(PalmHolder, TellsWhatAPalmGoesInto) {
    const Vec3 above(0.011, 0.2, 0.017);
    const auto below = [&](double down_m) -> Vec3 { return above - Vec3(0.003, down_m, 0.001); };
    const Vec3 half(0.1, 0.05, 0.1);
    Mesh box;
    add_box(Vec3::Zero(), half, box);
    EXPECT_FALSE(goes_in(box, above, above));
    EXPECT_FALSE(goes_in(box, above, below(0.1)));  // above it still
    EXPECT_TRUE(goes_in(box, above, below(0.2)));   // in it
    EXPECT_FALSE(goes_in(box, above, below(0.3)));  // through it
    EXPECT_FALSE(goes_in(box, below(0.2), above));  // out of it
    EXPECT_FALSE(goes_in(box, below(0.2), below(0.21)));

    Mesh stack = box;  // another below, face on face
    add_box(Vec3(0.0, -0.1, 0.0), half, stack);
    EXPECT_TRUE(goes_in(stack, above, below(0.2)));
    EXPECT_TRUE(goes_in(stack, above, below(0.3)));
    EXPECT_FALSE(goes_in(stack, above, below(0.4)));

    Mesh sheet;  // of both sides
    sheet.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
    EXPECT_FALSE(goes_in(sheet, above, below(0.3)));
    EXPECT_FALSE(goes_in(sheet, below(0.3), above));

    Mesh slats;
    for (int i = 0; i < 6; ++i) {
        add_box(Vec3(0.0, -0.02 * i, 0.0), Vec3(0.1, 0.004, 0.1), slats);
    }
    EXPECT_TRUE(goes_in(slats, above, below(0.28)));   // in the fifth
    EXPECT_FALSE(goes_in(slats, above, below(0.29)));  // between it and the sixth
}

// How deep surfaces go through a palm that is held there, of the mesh and of another under the
// hand.
double crossed_m(const Mesh& mesh, const Vec3& held, const GripMesh* other = nullptr) {
    const GripMesh grip = build_grip_mesh(mesh);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Tuning tuning;
    HeldPalm palm;
    palm.surface.held_bs = wrist_with_palm_at(rig, held, Vec3::UnitY());
    FittedHand hand(grip, palm.surface.held_bs);
    if (other != nullptr) {
        hand.hands.front().meshes.push_back({other, {}});
    }
    const HandSurroundings& surroundings = hand.hands.front();
    return PalmHolder(surroundings, surroundings.wrist_bs, test::k_at_once_s, tuning.palm)
        .crossed_m(palm);
}

TEST(PalmHolder, TellsWhatGoesThroughAPalm) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const PalmCapsule& capsule = rig.palm.front();
    const double length_m = (capsule.b_hs - capsule.a_hs).norm();
    const Vec3 middle_bs = Vec3(0.5 * (capsule.a_hs + capsule.b_hs) - rig.palm_center_hs);
    Mesh floor;
    add_box(Vec3(0.0, -0.05, 0.0), Vec3(0.3, 0.05, 0.3), floor);
    EXPECT_EQ(crossed_m(floor, {0.0, 0.05, 0.0}), 0.0);
    EXPECT_EQ(crossed_m(floor, {0.0, 0.012, 0.0}), 0.0);  // sunk, but its middles are outside

    Mesh wall;  // across the capsule's middle
    add_box(middle_bs, Vec3(0.3, 0.3, 1e-3), wall);
    const double crossed = crossed_m(wall, Vec3::Zero());
    EXPECT_GT(crossed, capsule.radius_m);
    EXPECT_LE(crossed, capsule.radius_m + length_m);
    const GripMesh other = build_grip_mesh(wall);
    EXPECT_EQ(crossed_m(floor, {0.0, 0.05, 0.0}, &other), crossed_m(wall, {0.0, 0.05, 0.0}));
    EXPECT_GT(crossed_m(floor, {0.0, 0.05, 0.0}, &other), 0.0);
}

}  // namespace
}  // namespace handhold::palm_holder_test
