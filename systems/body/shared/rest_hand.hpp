#pragma once

#include "components/arm.hpp"
#include "components/grab.hpp"
#include "components/tracking.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/body_view.hpp"

// Where a hand is shown that no device shows: the arm of a lost or never tracked hand goes to a
// rest pose beside the trunk, and back to the hand when it is tracked again.
namespace handhold {

// Greatest speed at which a hand leaves for its rest pose or comes back, relative to the player's
// view or to the tracked hand. For a player with an eye height of k_scale_eye_m.
inline constexpr double k_rest_speed_mps = 2.0;
inline constexpr double k_rest_spin_radps = 9.0;
// Greatest distance of a lost hand from its shoulder at rest, arm lengths.
inline constexpr double k_rest_reach = 1.2;

// The player's view, from which rest poses are given: at the eyes, level, facing `look_ps`.
Pose view_frame(const Vec3& eyes_ps, const Vec3& look_ps);

// The rest pose of a hand in the frame `view_ps` (view_frame). Hangs beside the trunk, above the
// tracked floor; along the trunk of a player who lies (`lying`: lying_share).
Pose rest_hand(HandSide side, const Pose& view_ps, double lying, const TrackedBody& body);

// What a hand's arm reaches for.
ArmGoal arm_goal(const Grab& grab, const HandTracking& tracking);

// What place_hand needs to know of one hand.
struct GivenHand {
    ArmGoal goal = ArmGoal::hand;
    Pose hand_ps;         // hand that the earlier stages show
    Pose rest_ps;         // rest_hand
    Pose view_ps;         // view_frame now
    Pose before_ps;       // hand that was shown last
    Pose view_before_ps;  // view_frame then
};

// Starts a hand without a past: at its rest pose if it is lost.
void start_hand(ArmGoal goal, HandRest& rest);

// Advances `rest` by one frame and returns the shown hand. A hand that is not at rest, nor on its
// way from or to its rest pose, is shown exactly as given. A hand that grips is too, at once.
Pose place_hand(const GivenHand& given, double scale, double dt_s, HandRest& rest);

// The nearest point to `hand_ps` within `most_m` of the shoulder.
Vec3 within_reach(const Vec3& hand_ps, const Vec3& shoulder_ps, double most_m);

}  // namespace handhold
