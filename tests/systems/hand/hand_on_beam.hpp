#pragma once

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::sweep_fingers_test {

using test::FittedHand;
using test::k_right;
using test::k_unbudgeted_s;
using test::Random;
using test::wrist_with_palm_at;

constexpr double k_dt_s = 1.0 / 90.0;

// A beam of 4 cm by 4 cm along x with its top in the plane y = 0; fingers along -Z close around it.
inline Mesh make_beam(double width_m = 0.04) {
    constexpr std::uint32_t k_pieces = 40;
    const double half_m = 0.5 * width_m;
    const std::array<std::array<double, 2>, 4> ring = {
        {{0.0, half_m}, {0.0, -half_m}, {-width_m, -half_m}, {-width_m, half_m}}};
    Mesh mesh;
    for (std::uint32_t i = 0; i <= k_pieces; ++i) {
        for (const auto& [y, z] : ring) {
            mesh.positions.emplace_back(0.4 * i / k_pieces - 0.2, y, z);
        }
    }
    for (std::uint32_t i = 0; i < k_pieces; ++i) {
        for (std::uint32_t side = 0; side < 4; ++side) {
            const std::uint32_t a = 4 * i + side;
            const std::uint32_t b = 4 * i + (side + 1) % 4;
            mesh.triangles.push_back({a, a + 4, b});
            mesh.triangles.push_back({b, a + 4, b + 4});
        }
    }
    for (const std::uint32_t end : {0U, 4 * k_pieces}) {
        const bool is_first = end == 0;
        mesh.triangles.push_back({end, end + (is_first ? 1U : 2U), end + (is_first ? 2U : 1U)});
        mesh.triangles.push_back({end, end + (is_first ? 2U : 3U), end + (is_first ? 3U : 2U)});
    }
    return mesh;
}

struct SweepFingers : testing::Test {
    GripMesh beam = build_grip_mesh(make_beam());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // The palm just behind the beam's top, the fingers above it.
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());

    // Largest penetration of the posed digits. Oracle: find_penetration, which has its own tests.
    static double deepest_m(FittedHand& hand) {
        double deepest = 0.0;
        for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
            const FingerAngles& angles = hand.pose().target[f];
            const HingeChain chain =
                finger_chain(hand.rig.fingers[f], angles.opposition_rad, hand.shown_bs());
            const auto capsules = chain_capsules(chain, angles.curl_rad);
            for (std::size_t i = 0; i < chain.link_count; ++i) {
                deepest = std::max(
                    deepest, find_penetration(capsules[i], hand.hands.front().meshes).depth_m);
            }
        }
        return deepest;
    }
};

}  // namespace handhold::sweep_fingers_test
