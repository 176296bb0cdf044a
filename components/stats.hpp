#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Statistics of one frame: stage times, counters, and every fallback with its reason. Not state.
namespace handhold {

// In frame order.
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
    solve_velocities,  // includes limit_velocities
    book_momentum,
    record_valid_poses,
    update_joints,
    gather_surroundings,
    search_grip,
    constrain_palms,
    sweep_fingers,
    fit_hands,
    estimate_arms,
    pose_arms,
    propagate_spine,
    layer_additives,
    publish_pose,
    count
};

// A fallback: the runtime could not do what was requested and did something else instead. Each
// event is counted.
enum class Fallback : std::uint8_t {
    // Input.
    sample_out_of_order,   // a sample older than the previous one: ignored
    sample_not_finite,     // one device's pose in a sample is not finite: ignored
    tracking_lost,         // a device is silent or invalid: its pose is frozen
    hand_out_of_reach,     // hand farther from its head than HandTuning::max_arm_m: sample ignored
    head_recentred,        // head moved more than TrackingTuning::max_jump_m: the player stays put
    device_asleep,         // a controller at exactly (0, 0, 0): sample ignored
    hand_implausible,      // faster than TrackingTuning::max_hand_speed_mps: sample ignored
    space_recentred,       // head and hands jumped as one rigid body: the player stays put
    sample_too_far_ahead,  // a sample more than 0.5 s or 64 samples after the frame: dropped
    // A sample more than 0.5 s before the frame, probably stamped by another clock.
    sample_too_old,
    // Grabs.
    grab_no_surface,       // a hand closed with no surface in reach
    grip_stretched,        // hand farther from its anchor than HandTuning::max_stretch_m: let go
    grip_lost,             // tracking returned with the hand open: let go without a throw
    grip_body_gone,        // the gripped body was destroyed: let go
    grip_reanchored,       // tracking returned or the other hand let go: anchor moved to the hand
    two_hand_grip_ended,   // one of two hands let go: the body is not thrown
    hands_too_close,       // both hands too close on one free body: only the first hand drives it
    grab_refused_by_rule,  // a body within reach or pull refuses the hand: GrabRule or GrabLayers
    grab_needs_two_hands,  // the rule asks for two hands, but only one closed
    grip_needs_two_hands,  // one of two hands left a two-handed body: the other lets go
    grip_ended_by_host,    // released by a GrabOrder
    grip_out_of_reach,     // palm too far from its surface after a tracking error: let go
    grip_speed_limited,    // a gripping hand was faster than max_hand_speed_mps: its anchor slips
    grab_out_of_sight,     // a wall stands between hand and surface: nothing gripped
    // Physics.
    contact_rounds_exhausted,  // new contacts appeared in every allowed round
    contacts_contradict,       // hands' constraints were dropped so that contacts could be met
    contacts_unresolved,       // contacts still overlap at the end of the frame
    // An island's penetrating bodies were restored to their last valid pose.
    restored_last_valid_pose,
    // A solve ended before its active set (pushing contacts and limits) converged.
    active_set_not_converged,
    hands_load_stepped,    // a solve ran out of iterations, then converged by load stepping
    load_stepping_failed,  // load stepping failed too: the first result is kept
    // A direct velocity solve did not converge or has no plausible result. Its last iterate or a
    // solve by sweeps is used.
    friction_not_converged,
    // An island spent its WorkBudget: its solve continues in the next frame.
    solver_budget,
    // Contacts of a deeply overlapping pair were postponed: CollisionWork::deferred_pairs.
    pairs_deferred,
    release_speed_clamped,
    object_speed_clamped,
    head_ignores_full,
    // Fingers and palms. Those of closing digits and hand_penetrates count again at each closing:
    // in every second frame for a hand that its fits lead into solids (fit_hands).
    finger_full_search,   // the seeded searches did not suffice: all triangles in reach were tested
    finger_depenetrated,  // the closed finger penetrated: moved to a sample pose
    finger_opened,        // the finger, closed or in a sample pose, penetrated: opened step by step
    finger_no_contact,    // a closing digit touches nothing: it bends like its neighbours
    hand_penetrates,      // the fit of a closing penetrates by more than 3 mm: shown penetrating
    body_no_surface,      // the gripped body has no grip mesh: hand shown as tracked
    palm_no_surface,      // a gripping palm has no near surface in sight: shown as a fist
    // Authored grips.
    authored_grip_occupied,  // another hand is in the grip: the next best grip or surface is used
    // An obstacle is between hand and grip: the next best grip or surface is used.
    authored_grip_blocked,
    authored_grip_abandoned,   // the hand turned too far: it continues as a surface grip
    authored_finger_rejected,  // the authored pose penetrates: the finger is fitted to the surface
    // Distance grab.
    pull_refused_fixed,  // the body cannot move or has joints
    pull_refused_heavy,  // the body is heavier than PullTuning::max_mass_kg
    pull_refused_held,   // the body is held, or pulled by another hand
    pull_lost,           // body gone, too far or held, or hand not tracked: the pull ends
    // Hosts.
    surface_answer_invalid,  // a host answered a query with invalid numbers: counts as no surface
    count
};

// Sums of all constraint impulses of one frame, by receiver: linear in kg m/s, angular about the
// world's origin in kg m^2/s. The receivers' sum is zero. `virtual_player` receives the momentum
// that the forward phase discards.
struct MomentumLedger {
    enum Receiver : std::uint8_t { objects, players, virtual_player, statics, receiver_count };
    std::array<Vec3, receiver_count> linear_kgmps{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                                  Vec3::Zero()};
    std::array<Vec3, receiver_count> angular_kgm2ps{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                                    Vec3::Zero()};
};

// Why a hand did not grip, or let go although its button is down: a fallback counted in this frame.
// `body` may be null.
struct HandNote {
    Entity hand;
    Entity body;
    Fallback reason = Fallback::count;
};

struct StageStats {
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> fallbacks{};
    // Duration of each stage in this frame, indexed by Stage.
    std::array<double, static_cast<std::size_t>(Stage::count)> stage_us{};

    std::uint64_t grab_onsets = 0;
    std::uint64_t grabs_gripped = 0;
    std::uint64_t islands = 0;
    std::uint64_t islands_pushed = 0;  // islands that ran the backward phase
    std::uint64_t contacts = 0;
    std::uint64_t contact_rounds = 0;     // narrowphase passes inside solve_phases
    std::uint64_t narrowphase_calls = 0;  // pairs whose contacts were computed, in all passes
    std::uint64_t bounds_updates = 0;     // colliders whose place in the broadphase was updated
    std::uint64_t tree_queries = 0;       // searches of the broadphase for pairs
    std::uint64_t active_bodies = 0;      // bodies and players that the physics stages processed
    std::uint64_t newton_iterations = 0;  // sum over all islands and phases
    double residual_m = 0.0;              // deepest contact overlap at the end of the frame
    double joint_error_m = 0.0;  // largest distance of a joint's points, or slider limit violation
    double joint_error_rad = 0.0;  // largest direction or angle limit error of a joint
    double hand_error_m = 0.0;     // largest distance between a hand and its anchor
    MomentumLedger ledger;
    std::vector<HandNote> hand_notes;  // chronological

    // Resets everything; keeps the capacity of hand_notes.
    void clear() {
        std::vector<HandNote> notes = std::move(hand_notes);
        *this = {};
        notes.clear();
        hand_notes = std::move(notes);
    }
    void note(Fallback reason, Entity hand, Entity body) {
        count(reason);
        hand_notes.push_back({hand, body, reason});
    }
    void count(Fallback reason) { ++fallbacks[static_cast<std::size_t>(reason)]; }
};

// The names used in reports, e.g. "find_contacts" and "grip_stretched".
const char* name_of(Stage stage);
const char* name_of(Fallback reason);

}  // namespace handhold
