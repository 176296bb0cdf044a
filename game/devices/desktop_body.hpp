#pragma once

#include <array>
#include <optional>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "game/session/hand_pose.hpp"

// Emulates a headset and two controllers with keyboard, mouse and gamepad: the player looks around,
// reaches for surfaces in view, and pulls on what they grip.
namespace handhold {

// Input of keys, mouse and gamepad in one frame.
struct DesktopInput {
    double turn_left_rad = 0.0;
    double look_up_rad = 0.0;
    std::array<bool, 2> grip{};    // indexed by hh::Side; held down now
    std::array<bool, 2> opened{};  // indexed by hh::Side; released at some time in the frame
    hh::Vec3 move{};               // right, up and back in the view, each [-1, 1]
    double farther_m = 0.0;        // pushes the held body away; negative: nearer
    bool hurry = false;            // doubles the pulling speed
    bool brake = false;
    double smooth_turn = 0.0;  // turn of the play space, [-1, 1], positive to the left
    int snap_turns = 0;        // number of turns to the left; negative: to the right
};

class DesktopBody {
  public:
    // Advances head and hands by `dt_s` to `t_s` and returns what a headset would report. In play
    // space the head does not move: only the hands move the player. Call it between frames.
    hh::Sample advance(hh::World& world, hh::Player player, const DesktopInput& input, double t_s,
                       double dt_s);

    // Turns the view to the nearest surface within reach, if there is one: before the first frame,
    // so that somebody who plays for the first time begins with a green mark.
    void face_nearest_surface(hh::World& world, hh::Player player);

    // The commands of the same frame: brake, turns and jets.
    hh_commands commands(const DesktopInput& input) const;
    // Whether a surface in view was within reach in the last frame.
    bool can_reach() const { return aim_ps_.has_value(); }
    // Where a hand that reaches now would lie, in play space; nullopt: no surface is in view.
    const std::optional<PalmTarget>& aim_ps() const { return aim_ps_; }

  private:
    struct Hand {
        hh::Pose hand_ps = hh::k_origin;
        hh::Pose carried_hs =
            hh::k_origin;  // pose in the head's frame when the hand began to move with the head
        double reaches_s = 0.0;
        bool closed = false;
    };
    enum class Use { opens, reaches, carries, pulls };

    hh::Pose rest_ps(hh::Side side, hh::Vec3 palm_center_m) const;
    void stop_at_surface(hh::World& world, hh::Player player, hh::Side side, hh::Vec3 palm_center_m,
                         hh::Pose& hand_ps) const;
    void aim(hh::World& world, hh::Player player);
    hh::Pose target_ps(hh::Side side, hh::Vec3 palm_center_m) const;
    static void reach(const hh::Pose& target_ps, double dt_s, Hand& hand);
    void pull(const hh::Vec3& move_ps);
    bool may_pull(const Hand& hand, hh::Side side, const hh::Vec3& move_ps) const;

    double yaw_rad_ = 0.0;
    double pitch_rad_ = 0.0;
    hh::Pose head_ps_ = hh::k_origin;
    std::optional<PalmTarget> aim_ps_;  // palm on the surface in view; nullopt: none in view
    std::array<Hand, 2> hands_;
    std::array<Use, 2> uses_{};
    bool has_hands_ = false;  // whether the hands have poses; false before the first frame
};

}  // namespace handhold
