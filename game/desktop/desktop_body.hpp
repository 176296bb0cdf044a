#pragma once

#include <array>
#include <optional>

#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"
#include "game/session/hand_pose.hpp"

// Keyboard, mouse and gamepad as a headset and two controllers: somebody without a headset who
// looks about, reaches for what he looks at, and pulls himself along by what he grips.
namespace handhold {

// What keys, mouse and gamepad ask for in one frame.
struct DesktopInput {
    double turn_left_rad = 0.0;
    double look_up_rad = 0.0;
    std::array<bool, k_hand_count> grip{};    // by HandSide; held down
    std::array<bool, k_hand_count> opened{};  // not held down for a moment of it
    Vec3 move = Vec3::Zero();                 // each in [-1, 1]: right, up, back, as he looks
    double farther_m = 0.0;                   // what he holds or is held by; negative: nearer
    bool hurry = false;                       // pulls twice as fast
    bool brake = false;
    double smooth_turn = 0.0;  // of the play space, [-1, 1], positive to the left
    int snap_turns = 0;        // to the left; negative: to the right
};

class DesktopBody {
  public:
    // Moves head and hands on by dt_s to t_s, and says what a headset would say then. `collision`
    // has every collider where it is now. In play space the head stays over the origin: where he
    // goes, his hands take him.
    TrackingSample advance(const Scene& scene, const CollisionWorld& collision,
                           const PlayerEntities& player, const DesktopInput& input, double t_s,
                           double dt_s);

    // Sticks and buttons of the same frame.
    PlayerCommands commands(const DesktopInput& input) const;
    // What he looks at is near enough to reach for; as of the last frame.
    bool can_reach() const { return aim_ps_.has_value(); }

  private:
    struct Hand {
        Pose hand_ps;
        Pose carried_hs;  // in the head's frame, when it began to go with the head
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
    std::optional<PalmFrame> aim_ps_;  // what he looks at
    std::array<Hand, k_hand_count> hands_;
    std::array<Use, k_hand_count> uses_{};
    bool has_hands_ = false;  // in play space: not before the first frame
};

}  // namespace handhold
