#pragma once

#include <algorithm>
#include <array>

#include "fitted_hand.hpp"

namespace handhold::test {

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

// Largest penetration of the digits at these angles, with the hand at `wrist_bs`. Oracle:
// find_penetration, which has its own tests.
inline double deepest_digit_m(const FittedHand& hand,
                              const std::array<FingerAngles, k_finger_count>& fingers,
                              const Pose& wrist_bs) {
    double deepest_m = 0.0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const HingeChain chain =
            finger_chain(hand.rig.fingers[f], fingers[f].opposition_rad, wrist_bs);
        const auto capsules = chain_capsules(chain, fingers[f].curl_rad);
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            deepest_m = std::max(deepest_m,
                                 find_penetration(capsules[i], hand.hands.front().meshes).depth_m);
        }
    }
    return deepest_m;
}

}  // namespace handhold::test
