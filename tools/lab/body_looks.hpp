#pragma once

#include <array>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "components/arm.hpp"
#include "components/spine.hpp"
#include "tools/lab/measure.hpp"

// Measures whether shown arms and legs look like a person's.
namespace handhold::lab {

// Limits; lengths are for an eye height of k_scale_eye_m.
inline constexpr double k_straight_knee_rad = 0.12;   // a leg bent less than this is a plank
inline constexpr double k_crossed_legs_m = 0.08;      // distance between the bones of two legs
inline constexpr double k_knee_at_shoulder_m = 0.22;  // distance between the joints
inline constexpr double k_inside_trunk_m = 0.11;      // distance from the line chest, waist, hips
inline constexpr double k_bent_wrist_rad = 100.0 / 180.0 * k_pi;

class BodyLooks {
  public:
    // Takes the next frame. scale: eye height / k_scale_eye_m. to_ps: rotation from the world to
    // the play space.
    void take(const SpinePose& spine, const ArmPose& arms, double scale, const Quat& to_ps,
              double dt_s);
    void restart() { before_ = {}; }  // the next frame does not continue the last one

    // Share of frames, percent, for each look; speeds of the feet relative to the chest.
    nlohmann::ordered_json json() const;

    // The looks of a frame, in the order of json(). avoidable_...: a turn of the elbow about the
    // line from shoulder to hand would do; the others follow from where shoulder and hand are.
    struct Frame {
        bool straight, crossed, high, ball, elbow, forearm, wrist;
        bool hand;  // a wrist within k_inside_trunk_m of the trunk's line
        bool avoidable_elbow, avoidable_forearm, avoidable_wrist;
    };
    const std::vector<Frame>& frames() const { return frames_; }

  private:
    void take_feet(const SpinePose& spine, const Quat& to_ps, double dt_s);

    struct Before {
        bool known = false;
        Vec3 foot_m = Vec3::Zero();
        std::optional<Vec3> mps;
    };
    std::vector<Frame> frames_;
    std::array<Before, k_hand_count> before_;
    Series foot_mps_, foot_step_mps_;
};

}  // namespace handhold::lab
