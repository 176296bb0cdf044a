#pragma once

#include <array>
#include <optional>

#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"
#include "game/session/hand_pose.hpp"

// Emulates a headset and two controllers with keyboard, mouse and gamepad: the player looks around,
// reaches for surfaces in view, and pulls on what they grip.
namespace handhold {

// Input of keys, mouse and gamepad in one frame.
struct DesktopInput {
    double turn_left_rad = 0.0;
    double look_up_rad = 0.0;
    std::array<bool, k_hand_count> grip{};  // indexed by HandSide; held down now
    std::array<bool, k_hand_count>
        opened{};              // indexed by HandSide; released at some time in the frame
    Vec3 move = Vec3::Zero();  // right, up and back in the view, each [-1, 1]
    double farther_m = 0.0;    // pushes the held body away; negative: nearer
    bool hurry = false;        // doubles the pulling speed
    bool brake = false;
    double smooth_turn = 0.0;  // turn of the play space, [-1, 1], positive to the left
    int snap_turns = 0;        // number of turns to the left; negative: to the right
};

class DesktopBody {
  public:
    // Advances head and hands by `dt_s` to `t_s` and returns what a headset would report. In play
    // space the head does not move: only the hands move the player. Precondition: every collider of
    // `collision` is at its current pose.
    TrackingSample advance(const Scene& scene, const CollisionWorld& collision,
                           const PlayerEntities& player, const DesktopInput& input, double t_s,
                           double dt_s);

    // The commands of the same frame: brake, turns and jets.
    PlayerCommands commands(const DesktopInput& input) const;
    // Whether a surface in view was within reach in the last frame.
    bool can_reach() const { return aim_ps_.has_value(); }

  private:
    struct Hand {
        Pose hand_ps;
        Pose carried_hs;  // pose in the head's frame when the hand began to move with the head
        double reaches_s = 0.0;
        bool closed = false;
    };
    enum class Use { opens, reaches, carries, pulls };

    Pose rest_ps(HandSide side, const HandTuning& tuning) const;
    void aim(const Scene& scene, const CollisionWorld& collision, const PlayerEntities& player);
    Pose target_ps(HandSide side, const HandTuning& tuning) const;
    static void reach(const Pose& target_ps, double dt_s, Hand& hand);
    void pull(const Vec3& move_ps);
    bool may_pull(const Hand& hand, HandSide side, const Vec3& move_ps) const;

    double yaw_rad_ = 0.0;
    double pitch_rad_ = 0.0;
    Pose head_ps_;
    std::optional<PalmTarget> aim_ps_;  // palm on the surface in view; nullopt: none in view
    std::array<Hand, k_hand_count> hands_;
    std::array<Use, k_hand_count> uses_{};
    bool has_hands_ = false;  // whether the hands have poses; false before the first frame
};

}  // namespace handhold
