// Hands on real and on broken meshes: fingers stay finite and within their limits, and every
// fallback is counted.
#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "tests/engine/geometry/data_meshes.hpp"

namespace handhold::hand_real_data_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::Random;

void expect_within_limits(FittedHand& hand) {
    EXPECT_TRUE(is_finite(hand.shown_bs().position));
    EXPECT_NEAR(hand.shown_bs().rotation.norm(), 1.0, 1e-9);
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        for (const FingerAngles& angles : {hand.pose().target[f], hand.pose().shown[f]}) {
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                EXPECT_GE(angles.curl_rad[i], finger.lower_rad[i] - 1e-9);
                EXPECT_LE(angles.curl_rad[i], finger.upper_rad[i] + 1e-9);
            }
        }
        EXPECT_GE(hand.traces[0][f].depth_m, 0.0);
        EXPECT_LT(hand.traces[0][f].depth_m, 1.0);
    }
}

// Every finger's fallback and every missing surface is counted exactly once.
void expect_counted(FittedHand& hand) {
    const bool has_surface = hand.surface.at(k_right).triangle != GripSurface::k_none;
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), has_surface ? 0U : 1U);
    std::uint64_t without_contact = 0;
    std::uint64_t depenetrated = 0;
    std::uint64_t opened = 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const ChainFallback fallback = hand.traces[0][f].fallback;
        without_contact += fallback == ChainFallback::rest_pose ? 1 : 0;
        depenetrated += fallback == ChainFallback::sample_pose ? 1 : 0;
        opened += fallback == ChainFallback::opened ? 1 : 0;
    }
    EXPECT_EQ(test::count_of(hand.stats, Fallback::finger_no_contact), without_contact);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::finger_depenetrated), depenetrated);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::finger_opened), opened);
}

// Grips with palms at random orientations within a few centimetres of random triangles. Returns how
// many found a surface.
int grip_everywhere(const GripMesh& mesh, std::uint64_t seed) {
    constexpr int k_placements = 24;
    Random random(seed);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    int gripped = 0;
    for (int i = 0; i < k_placements; ++i) {
        const auto count = static_cast<double>(mesh.contact.triangles.size());
        const auto triangle = static_cast<std::size_t>(random.between(0.0, count - 0.5));
        const Vec3 point = mesh.contact.positions[mesh.contact.triangles[triangle][0]];
        const Quat rotation = random.rotation();
        FittedHand hand(mesh,
                        {point + random.vector(0.03) - rotation * rig.palm_center_hs, rotation});
        hand.frame(test::k_unlimited_s);
        expect_within_limits(hand);
        expect_counted(hand);
        gripped += hand.surface.at(k_right).triangle != GripSurface::k_none ? 1 : 0;
    }
    return gripped;
}

void grip_all_of(const char* folder) {
    const auto files = test::data_files(folder);
    if (files.empty()) {
        GTEST_SKIP() << "no data";
    }
    std::uint64_t seed = 2400;
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename().string());
        const Mesh mesh = test::load_whole(file);
        if (mesh.triangles.empty()) {
            continue;  // the loader reported the reason
        }
        const GripMesh grip = build_grip_mesh(mesh);
        if (!grip.contact.triangles.empty()) {
            EXPECT_GE(grip_everywhere(grip, ++seed), 16);  // the others have it at back or edge
        }
    }
}

TEST(HandsOnRealMeshes, StayFiniteAndCountFallbacksOnObjects) { grip_all_of("objects"); }
TEST(HandsOnRealMeshes, StayFiniteAndCountFallbacksOnBrokenMeshes) { grip_all_of("nasty"); }

}  // namespace
}  // namespace handhold::hand_real_data_test
