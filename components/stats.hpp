#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/math/math.hpp"

// What a frame says about itself: times, counters, and every fallback with its reason. Not state.
namespace handhold {

// In the order of the frame.
enum class Stage : std::uint8_t {
    read_tracking,
    calibrate_players,
    group_joints,
    update_grabs,
    locomote_players,
    animate_movers,
    predict_bodies,
    anchor_grabs,
    find_contacts,
    build_constraints,
    solve_phases,
    update_velocities,
    update_joints,
    gather_surroundings,
    search_grip,
    constrain_palms,
    sweep_fingers,
    pose_thumb,
    estimate_arms,
    pose_arms,
    propagate_spine,
    layer_additives,
    publish_pose,
    count
};

// Bad play and bad luck: what the runtime did instead of what was asked.
enum class Fallback : std::uint8_t {
    sample_out_of_order,   // a sample older than the one before: ignored
    sample_not_finite,     // one device's pose in one sample: ignored
    tracking_lost,         // a device became silent or invalid: its pose is frozen
    hand_out_of_reach,     // farther from its head than HandTuning::max_arm_m in a sample: ignored
    head_recentred,        // a head farther than TrackingTuning::max_jump_m: nobody moved
    device_asleep,         // a controller at exactly (0, 0, 0) in a sample: ignored
    hand_implausible,      // faster than TrackingTuning::max_hand_speed_mps in a sample: ignored
    play_space_recentred,  // head and hands jumped as one rigid body: nobody moved
    grab_no_surface,       // a hand closed on nothing
    grip_stretched,        // a hand farther from its anchor than HandTuning::max_stretch_m: let go
    grip_lost,             // a hand came back from lost tracking open: let go, no throw
    grip_body_gone,        // the gripped body was destroyed: let go
    grip_reanchored,      // tracking came back, or the other hand left: anchor taken anew where the
                          // hand is
    two_hand_grip_ended,  // one of two hands let go: no throw
    hands_too_close,  // two hands on one free body with no line between them: the first leads alone
    grip_out_of_reach,   // after a tracking jump the palm is too far from what it grips: let go
    grip_speed_limited,  // a gripping hand exceeded max_hand_speed_mps: its anchor slipped
    grab_out_of_sight,   // a wall stands between the hand and the surface: nothing gripped
    contact_rounds_exhausted,  // new contacts after every allowed round
    contacts_contradict,       // hand rows set aside so that contacts could be met
    contacts_unresolved,       // contacts still overlapping at the end of the frame
    restored_last_valid_pose,  // islands whose sunk bodies went back to where they were clear
    active_set_not_converged,  // solves that ended before it was clear which contacts push
    hands_load_stepped,      // solves that ran out of steps and then took hands there part by part
    load_stepping_failed,    // the same, but not even the parts could be had: as the steps left it
    friction_wedged,         // contacts that would press without end or give energy slip freely
    friction_not_converged,  // who sticks and who slides was not settled within its passes
    release_speed_clamped,
    object_speed_clamped,
    head_ignores_full,
    finger_full_search,        // a finger whose searches did not do looked at all within its reach
    finger_depenetrated,       // sunk straight or as it closed: bent until it was clear
    finger_opened,             // and opened a little, since it was sunk still
    finger_no_contact,         // a finger or thumb of a gripping hand met nothing: in the air
    palm_lifted,               // a hand was lifted off its surface, since its fingers did not fit
    body_no_surface,           // a gripped body without a grip mesh: the hand is shown as tracked
    palm_no_surface,           // a gripping hand with nothing under its palm is shown as tracked
    authored_grip_occupied,    // a hand closed where another sits in the grip: the next best
    authored_grip_blocked,     // something else is between the hand and the grip: the next best
    authored_grip_abandoned,   // a hand turned far away from its grip: held on to as to any surface
    authored_finger_rejected,  // a posed finger would be sunk: closed as on any surface
    pull_refused_fixed,        // a distance grab at what cannot move, or has joints: none
    pull_refused_heavy,        // at more than PullTuning::max_mass_kg: none
    pull_refused_held,         // at what is in a hand, or another pulls: none
    pull_lost,                 // what was pulled is gone, too far or in another hand, or the hand
                               // was lost: it flies on
    count
};

// Linear momentum given in one frame by all constraint impulses, by who received it, kg m/s, and
// angular about the world's origin, kg m^2/s. The four sum to zero: what the virtual player takes
// is what the forward phase discards.
struct MomentumLedger {
    enum Receiver : std::uint8_t { objects, players, virtual_player, statics, receiver_count };
    std::array<Vec3, receiver_count> linear_kgmps{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                                  Vec3::Zero()};
    std::array<Vec3, receiver_count> angular_kgm2ps{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                                    Vec3::Zero()};
};

struct StageStats {
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> fallbacks{};
    std::array<double, static_cast<std::size_t>(Stage::count)>
        stage_us{};  // of this frame; stage_now_ns

    std::uint64_t grab_onsets = 0;
    std::uint64_t grabs_gripped = 0;
    std::uint64_t islands = 0;
    std::uint64_t islands_pushed = 0;  // backward phases
    std::uint64_t contacts = 0;
    std::uint64_t contact_rounds = 0;     // narrowphase passes inside solve_phases
    std::uint64_t newton_iterations = 0;  // over all islands and phases
    double residual_m = 0.0;              // worst contact overlap at the end of the frame
    double joint_error_m = 0.0;           // worst joint: points, and limits passed, in metres
    double joint_error_rad = 0.0;         // the same of directions and angles
    double hand_error_m = 0.0;            // worst hand against its anchor
    MomentumLedger ledger;

    void count(Fallback reason) { ++fallbacks[static_cast<std::size_t>(reason)]; }
};

// "find_contacts", "grip_stretched": as in reports.
const char* name_of(Stage stage);
const char* name_of(Fallback reason);

}  // namespace handhold
