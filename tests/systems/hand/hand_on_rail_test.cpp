// Hands on a rail in front of a wall, reached from the free side. Tracking is never exact: a hand
// tracked inside or behind the bar still came from the free side.
#include <gtest/gtest.h>

#include "fitted_hand.hpp"

namespace handhold::hand_on_rail_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::wrist_with_palm_at;

constexpr double k_bar_radius_m = 0.017;
constexpr double k_bar_height_m = 0.04;  // height of the bar's axis above the wall

// In the plane y = 0, facing up.
Mesh make_wall() { return test::make_floor_mesh(); }

// A tube along X above the wall, open at its ends.
Mesh make_bar() {
    constexpr std::uint32_t k_around = 12;
    constexpr std::uint32_t k_rings = 20;
    Mesh mesh;
    for (std::uint32_t ring = 0; ring <= k_rings; ++ring) {
        for (std::uint32_t k = 0; k < k_around; ++k) {
            const double angle_rad = 2.0 * k_pi * k / k_around;
            mesh.positions.emplace_back(0.8 * ring / k_rings - 0.4,
                                        k_bar_height_m + k_bar_radius_m * std::cos(angle_rad),
                                        k_bar_radius_m * std::sin(angle_rad));
        }
    }
    for (std::uint32_t ring = 0; ring < k_rings; ++ring) {
        for (std::uint32_t k = 0; k < k_around; ++k) {
            const std::uint32_t here = ring * k_around + k;
            const std::uint32_t next = ring * k_around + (k + 1) % k_around;
            mesh.triangles.push_back({here, here + k_around, next});
            mesh.triangles.push_back({next, here + k_around, next + k_around});
        }
    }
    return mesh;
}

Mesh joined(Mesh a, const Mesh& b) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& [i, j, k] : b.triangles) {
        a.triangles.push_back({first + i, first + j, first + k});
    }
    return a;
}

Mesh transformed_by(const Pose& pose, Mesh mesh) {
    for (Vec3& position : mesh.positions) {
        position = transform_point(pose, position);
    }
    return mesh;
}

// The wall, the bar, and both as one mesh, transformed by `rail_bs`.
struct RailMeshes {
    GripMesh both;
    GripMesh bar;
    GripMesh wall;

    explicit RailMeshes(const Pose& rail_bs)
        : both(build_grip_mesh(transformed_by(rail_bs, joined(make_wall(), make_bar())))),
          bar(build_grip_mesh(transformed_by(rail_bs, make_bar()))),
          wall(build_grip_mesh(transformed_by(rail_bs, make_wall()))) {}
};

// Shown palm in the rail's frame.
struct ShownPalm {
    Vec3 center;
    Vec3 up;
};

ShownPalm shown_in_rail(FittedHand& hand, const Pose& rail_bs) {
    hand.search();
    hand.constrain();
    return {inverse_transform_point(rail_bs, hand.palm_center_bs()),
            rail_bs.rotation.conjugate() * hand.palm_up_bs()};
}

void expect_on_free_side(const ShownPalm& palm) {
    // Above the bar and not beside it, the back of the hand facing the free side.
    EXPECT_GT(palm.center.y(), k_bar_height_m + 0.5 * k_bar_radius_m);
    EXPECT_LT(std::abs(palm.center.z()), 1.5 * k_bar_radius_m);
    EXPECT_GT(palm.up.y(), 0.7);
    // On the bar: the distance is at most the palm's maximum height plus the hollow of the hand.
    const double off_axis_m = std::hypot(palm.center.y() - k_bar_height_m, palm.center.z());
    EXPECT_LT(off_axis_m, k_bar_radius_m + 0.02);
}

TEST(HandOnRail, StaysOnTheSideItReachedFromEvenIfItCrossedTheBar) {
    test::Random random(2301);
    for (int placement = 0; placement < 6; ++placement) {
        const Pose rail_bs = placement == 0 ? Pose{} : random.pose();
        const RailMeshes meshes(rail_bs);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const HandRig rig = builtin_hand_rig(side);
            // Down to the height at which the palm's centre leaves the back of the bar. Lower palms
            // may have come from either side.
            for (double height_m = 0.03; height_m > -0.0301; height_m -= 0.005) {
                const Vec3 center = {
                    random.between(-0.1, 0.1),
                    k_bar_height_m + k_bar_radius_m + height_m,
                    random.between(-0.01, 0.01),
                };
                const Vec3 up = (Vec3::UnitY() + random.vector(0.2)).normalized();
                const Pose wrist_bs = rail_bs * wrist_with_palm_at(rig, center, up);
                SCOPED_TRACE(testing::Message() << "placement " << placement << ", " << height_m);
                FittedHand on_one_body(meshes.both, wrist_bs, side);
                expect_on_free_side(shown_in_rail(on_one_body, rail_bs));
                FittedHand before_second_body(meshes.bar, wrist_bs, side);
                before_second_body.hands.front().meshes.push_back({&meshes.wall, {}});
                expect_on_free_side(shown_in_rail(before_second_body, rail_bs));
            }
        }
    }
}

}  // namespace
}  // namespace handhold::hand_on_rail_test
