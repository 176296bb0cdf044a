#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/tracking.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/level_direction.hpp"

// Head and hands as the estimators see them, and the inputs of their networks. A network describes
// the right arm; the left arm's inputs and outputs are mirrored (x negated, hands exchanged), so
// that a mirrored player has exactly mirrored arms.
namespace handhold {

// Head and hands at one time, play space, and the player's size.
struct TrackedBody {
    Pose head_ps;
    std::array<Pose, k_hand_count> hands_ps;
    const BodyMeasures& measures;
    double floor_m = 0.0;  // height of the tracked floor, play space
};

inline double arm_length_m(const BodyMeasures& measures) {
    return measures.upper_arm_m + measures.forearm_m;
}

// Rotations as matrices, play space.
struct BodyAxes {
    Mat3 head;
    std::array<Mat3, k_hand_count> hands;
};
inline BodyAxes axes_of(const TrackedBody& body) {
    return {body.head_ps.rotation.toRotationMatrix(),
            {body.hands_ps[0].rotation.toRotationMatrix(),
             body.hands_ps[1].rotation.toRotationMatrix()}};
}

// Directions of head and hands in the axes of a level facing. Unit vectors.
struct BodyView {
    Vec3 head_up;
    Vec3 head_ahead;
    std::array<Vec3, k_hand_count> fingers;
    std::array<Vec3, k_hand_count> back;  // out of the back of the hand
};
inline BodyView view_from(const Vec3& facing, const BodyAxes& axes) {
    const auto ahead_of = [&](const Mat3& m) { return to_facing(facing, -m.col(2)); };
    const auto up_of = [&](const Mat3& m) { return to_facing(facing, m.col(1)); };
    return {up_of(axes.head),
            ahead_of(axes.head),
            {ahead_of(axes.hands[0]), ahead_of(axes.hands[1])},
            {up_of(axes.hands[0]), up_of(axes.hands[1])}};
}

inline Vec3 mirrored_if_left(const Vec3& v, HandSide side) {
    return side == HandSide::right ? v : Vec3(-v.x(), v.y(), v.z());
}

// Collects a network's inputs for one side.
template <std::size_t Inputs>
class SideInputs {
  public:
    explicit SideInputs(HandSide side) : side_(side) {}

    void add(double value) { values_[count_++] = static_cast<float>(value); }
    // A value that changes its sign in the mirror.
    void add_lateral(double value) { add(side_ == HandSide::right ? value : -value); }
    void add(const Vec3& v) {
        add_lateral(v.x());
        add(v.y());
        add(v.z());
    }
    // All products a_i b_j.
    void add_products(const Vec3& a, const Vec3& b) {
        const Vec3 a_right = mirrored_if_left(a, side_);
        const Vec3 b_right = mirrored_if_left(b, side_);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                add(a_right[i] * b_right[j]);
            }
        }
    }
    const std::array<float, Inputs>& values() const { return values_; }

  private:
    HandSide side_;
    std::size_t count_ = 0;
    std::array<float, Inputs> values_{};
};

}  // namespace handhold
