#pragma once

#include <algorithm>
#include <array>

#include "fitted_hand.hpp"

namespace handhold::test {

// A beam of 4 cm by 4 cm along x with its top in the plane y = 0; fingers along -Z close around it.
// Its cells are fine enough for mean normals to turn gradually at its edges.
inline Mesh make_beam(double width_m = 0.04) {
    constexpr std::uint32_t k_along = 40;
    constexpr std::uint32_t k_across = 4;
    constexpr std::uint32_t k_ring = 4 * k_across;
    const double half_m = 0.5 * width_m;
    const std::array<Vec3, 4> corners = {Vec3(0.0, 0.0, half_m), Vec3(0.0, 0.0, -half_m),
                                         Vec3(0.0, -width_m, -half_m), Vec3(0.0, -width_m, half_m)};
    Mesh mesh;
    for (std::uint32_t i = 0; i <= k_along; ++i) {
        for (std::uint32_t k = 0; k < k_ring; ++k) {
            const Vec3& from = corners[k / k_across];
            const Vec3& to = corners[(k / k_across + 1) % 4];
            const double share = static_cast<double>(k % k_across) / k_across;
            mesh.positions.emplace_back(
                Vec3((0.4 * i / k_along - 0.2) * Vec3::UnitX() + from + share * (to - from)));
        }
    }
    for (std::uint32_t i = 0; i < k_along; ++i) {
        for (std::uint32_t k = 0; k < k_ring; ++k) {
            const std::uint32_t a = k_ring * i + k;
            const std::uint32_t b = k_ring * i + (k + 1) % k_ring;
            mesh.triangles.push_back({a, a + k_ring, b});
            mesh.triangles.push_back({b, a + k_ring, b + k_ring});
        }
    }
    for (const double end : {0.0, 1.0}) {
        const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.emplace_back(0.4 * end - 0.2, -half_m, 0.0);
        const std::uint32_t first = end > 0.0 ? k_ring * k_along : 0;
        for (std::uint32_t k = 0; k < k_ring; ++k) {
            const std::uint32_t a = first + k;
            const std::uint32_t b = first + (k + 1) % k_ring;
            mesh.triangles.push_back(end > 0.0 ? std::array{middle, b, a}
                                               : std::array{middle, a, b});
        }
    }
    return mesh;
}

// Largest penetration of a digit at these angles, with the hand at `wrist_bs`. Oracle:
// find_penetration, which has its own tests.
inline double digit_depth_m(const FittedHand& hand, std::size_t finger, const FingerAngles& angles,
                            const Pose& wrist_bs) {
    const HingeChain chain =
        finger_chain(hand.rig.fingers[finger], angles.opposition_rad, wrist_bs);
    const auto capsules = chain_capsules(chain, angles.curl_rad);
    double deepest_m = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        deepest_m =
            std::max(deepest_m, find_penetration(capsules[i], hand.hands.front().meshes).depth_m);
    }
    return deepest_m;
}

inline double deepest_digit_m(const FittedHand& hand,
                              const std::array<FingerAngles, k_finger_count>& fingers,
                              const Pose& wrist_bs) {
    double deepest_m = 0.0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        deepest_m = std::max(deepest_m, digit_depth_m(hand, f, fingers[f], wrist_bs));
    }
    return deepest_m;
}

}  // namespace handhold::test
