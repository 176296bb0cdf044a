#pragma once

// Handhold in C++20: a thin wrapper over handhold.h. Header only; needs neither exceptions nor RTTI
// nor Eigen. Ids, definitions and outputs are those of handhold.h, whose comments hold here too;
// this header adds ownership, spans and defaults.
//
// Calls return Status, which converts to true on success, or Maybe<T>, which has a value on
// success. Neither may be ignored.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <handhold/level.hpp>

namespace hh {

// A world and everything in it. After a failed construction is_valid is false and every call fails
// with HH_ERROR_NULL.
class World : public Level {
  public:
    World() : World(world_def()) {}
    using Level::Level;

    using Level::mass_kg;
    using Level::pose;
    using Level::poses;
    using Level::teleport;

    // ---- Players ----

    // Places a play space at once, at rest. Dynamic bodies in its hands that no joint holds come
    // along.
    Status teleport(Player player, Pose origin) {
        return hh_player_teleport(world_, player, origin);
    }
    // Samples are wrists with OpenXR's axes, not controllers.
    Status use_wrists(Player player) {
        const Pose identity = hh_identity_pose();
        const hh_result left = hh_player_set_hand_in_controller(world_, player, HH_LEFT, &identity);
        return left != HH_OK
                   ? left
                   : hh_player_set_hand_in_controller(world_, player, HH_RIGHT, &identity);
    }
    // Play space, head, velocity and hands.
    Maybe<hh_player_pose> pose(Player player) const {
        return make<hh_player_pose>(
            [&](hh_player_pose* p) { return hh_world_player_poses(world_, &player, 1, p); });
    }
    // Poses of many players; none is written if an id is stale. `poses` is at least as long as
    // `players`.
    Status poses(std::span<const Player> players, std::span<hh_player_pose> poses) const {
        return poses.size() < players.size()
                   ? HH_ERROR_CAPACITY
                   : hh_world_player_poses(world_, players.data(), players.size(), poses.data());
    }
    // What the hand grips, and where it is tracked and shown.
    Maybe<hh_hand_state> hand(Player player, Side side) const {
        return make<hh_hand_state>(
            [&](hh_hand_state* h) { return hh_player_hand(world_, player, side, h); });
    }
    // True if the hand's grip moves its player.
    bool moves_player(Player player, Side side) const {
        std::uint8_t moves = 0;
        return hh_hand_moves_player(world_, player, side, &moves) == HH_OK && moves != 0;
    }
    // The velocity that counts as rest for the player.
    Maybe<Vec3> reference_velocity_mps(Player player) const {
        return make<Vec3>([&](Vec3* v) { return hh_player_reference_velocity(world_, player, v); });
    }
    // How far contacts moved the play space in the last step, against its hands and its velocity.
    Maybe<double> push_back_m(Player player) const {
        return make<double>([&](double* d) { return hh_player_push_back(world_, player, d); });
    }
    // hh_player_def::mass_kg.
    Maybe<double> mass_kg(Player player) const {
        return make<double>([&](double* m) { return hh_player_mass(world_, player, m); });
    }
    // The wrist in the frame of the player's samples, in the world's metres.
    Maybe<Pose> hand_in_controller(Player player, Side side) const {
        return make<Pose>(
            [&](Pose* p) { return hh_player_hand_in_controller(world_, player, side, p); });
    }
    // The wrist in a controller's frame by the tuning.
    Maybe<Pose> hand_in_controller(Side side) const {
        return make<Pose>([&](Pose* p) { return hh_world_hand_in_controller(world_, side, p); });
    }
    // Sets the wrist in the frame of the player's samples. It does not scale with the player.
    Status set_hand_in_controller(Player player, Side side, const Pose& hand_in_controller) {
        return hh_player_set_hand_in_controller(world_, player, side, &hand_in_controller);
    }
    // Ids of all players.
    std::vector<Player> players() const { return all<Player>(&hh_world_players); }
    // Indexed by hh_hand_joint_name.
    using HandJoints = std::array<hh_hand_joint, HH_HAND_JOINT_COUNT>;
    // Joints of the shown hand, with the axes of XR_EXT_hand_tracking.
    Maybe<HandJoints> hand_joints(Player player, Side side, hh_space space) const {
        return make<HandJoints>([&](HandJoints* joints) {
            return hh_player_hand_joints(world_, player, side, space, joints->data());
        });
    }
    // Indexed by hh_body_joint.
    using BodyJoints = std::array<Pose, HH_BODY_JOINT_COUNT>;
    // Joints of the shown body, with VRM's names.
    Maybe<BodyJoints> body_joints(Player player, hh_space space) const {
        return make<BodyJoints>([&](BodyJoints* joints) {
            return hh_player_body_joints(world_, player, space, joints->data());
        });
    }
    // The body drives a skeleton given as an array: the joints of an engine's avatar.
    Status set_body_skeleton(Player player, std::span<const hh_skeleton_joint> joints,
                             hh_space space) {
        return hh_player_set_body_skeleton(world_, player, joints.data(), joints.size(), space);
    }
    // Joints of the body rig, in the order in which they were given. `joints` is at least as long
    // as the rig; returns the number of joints.
    Maybe<std::size_t> skeleton(Player player, hh_space space, std::span<Pose> joints) {
        return make<std::size_t>([&](std::size_t* count) {
            return hh_player_skeleton(world_, player, space, joints.data(), joints.size(), count);
        });
    }
    // In the next step the hand grips the body where both are, at any distance.
    Status grip(Player player, Side side, Body body) {
        return hh_hand_grip(world_, player, side, body);
    }
    // In the next step the hand lets go, without a throw.
    Status release(Player player, Side side) { return hh_hand_release(world_, player, side); }

    // ---- Stepping ----

    // Steps the world. Players without an input are silent.
    Status step(double dt_s, std::span<const hh_player_input> inputs = {}) {
        return hh_world_step(world_, dt_s, inputs.data(), inputs.size());
    }
    // Steps a world with one player.
    Status step(double dt_s, const hh_player_input& input) {
        return hh_world_step(world_, dt_s, &input, 1);
    }
    // A step without what hosts draw, for rollback. Changes no bit of the simulated state.
    Status step_simulated(double dt_s, std::span<const hh_player_input> inputs = {}) {
        return hh_world_step_simulated(world_, dt_s, inputs.data(), inputs.size());
    }
    // While the game is paused: players follow their last sample, the world stands still.
    Status step_pose_only(double dt_s, std::span<const hh_player_input> inputs) {
        return hh_world_step_pose_only(world_, dt_s, inputs.data(), inputs.size());
    }

    // ---- For hosts with their own physics (your_physics.h) ----

    // From now on hands, trunks and legs ask the host for surfaces, not the world's shapes.
    Status set_surface_query(const hh_surface_query& query) {
        return hh_world_set_surface_query(world_, &query);
    }
    // The triangles that palm and fingers close on, for a body without a shape.
    Status set_surface(Body body, const Mesh& mesh) {
        return hh_body_set_surface(world_, body, mesh.get());
    }
    // Where bodies are now. Ends no grip, unlike a teleport.
    Status place(std::span<const hh_body_motion> motions) {
        return hh_world_place_bodies(world_, motions.data(), motions.size());
    }
    // Where a play space is now. Ends no grip, unlike a teleport.
    Status place(Player player, Pose origin, Vec3 velocity_mps = {}) {
        return hh_player_place(world_, player, origin, velocity_mps);
    }
    // The hand holds the body from now on; a null id: nothing. For worlds that step_hands steps.
    Status hold(Player player, Side side, Body body, const Pose* anchor = nullptr) {
        return hh_hand_hold(world_, player, side, body, anchor);
    }
    // What the hand would grip if it closed where it is; a null body: nothing.
    Maybe<hh_surface_hit> find_grip(Player player, Side side) {
        return make<hh_surface_hit>(
            [&](hh_surface_hit* hit) { return hh_hand_find_grip(world_, player, side, hit); });
    }
    // Reads tracking and shows hands and bodies. Moves neither players nor bodies.
    Status step_hands(double dt_s, std::span<const hh_player_input> inputs) {
        return hh_world_step_hands(world_, dt_s, inputs.data(), inputs.size());
    }
    // First half of a step around the host's solver: tracking, grips and constraints.
    Status begin_step(double dt_s, std::span<const hh_player_input> inputs) {
        return hh_world_begin_step(world_, dt_s, inputs.data(), inputs.size());
    }
    // Constraints of the hands for the host's solver. Valid until end_step.
    std::span<const hh_hand_constraint> hand_constraints() const {
        return list<hh_hand_constraint>(&hh_world_hand_constraints);
    }
    // Each player's body for the host's solver. Valid until end_step.
    std::span<const hh_player_motion> player_motions() const {
        return list<hh_player_motion>(&hh_world_player_motions);
    }
    // Second half: takes the solved play spaces and shows hands and bodies.
    Status end_step(std::span<const hh_solved_player> players) {
        return hh_world_end_step(world_, players.data(), players.size());
    }
    // Velocities that the host must give its bodies. Valid until the next step.
    std::span<const hh_velocity_change> velocity_changes() const {
        return list<hh_velocity_change>(&hh_world_velocity_changes);
    }
    // The world's clock.
    double time_s() const {
        double time_s = 0.0;
        return hh_world_time(world_, &time_s, nullptr) == HH_OK ? time_s : 0.0;
    }
    // The number of steps.
    std::uint64_t frame() const {
        std::uint64_t frame = 0;
        return hh_world_time(world_, nullptr, &frame) == HH_OK ? frame : 0;
    }
    // The velocity of the scene.
    Vec3 reference_velocity_mps() const {
        Vec3 velocity{};
        return hh_world_reference_velocity(world_, &velocity) == HH_OK ? velocity : Vec3{};
    }
    // How often each fallback occurred in the last step, by index of hh_fallback_name.
    std::vector<std::uint64_t> fallbacks() const { return all<std::uint64_t>(&hh_world_fallbacks); }
    // Microseconds of each stage in the last step, by index of hh_stage_name.
    std::vector<double> stage_times_us() const { return all<double>(&hh_world_stage_times); }
    // The events of the last step, in a fixed order. Valid until the next step or restore.
    std::span<const Event> events() const {
        const Event* first = nullptr;
        std::size_t count = 0;
        return hh_world_events(world_, &first, &count) == HH_OK ? std::span(first, count)
                                                                : std::span<const Event>();
    }
    // Numbers of the last step.
    Maybe<hh_world_stats> stats() const {
        hh_world_stats stats = hh_default_world_stats();
        const hh_result result = hh_world_get_stats(world_, &stats);
        return {result, stats};
    }

    // ---- Saving ----

    // Saves every bit of the state. `bytes` keeps its memory from call to call.
    Status save(std::vector<std::byte>& bytes) {
        std::size_t size = 0;
        hh_result result = hh_world_save(world_, bytes.data(), bytes.size(), &size);
        if (result == HH_ERROR_CAPACITY || (result == HH_OK && bytes.empty())) {
            bytes.resize(size);
            result = hh_world_save(world_, bytes.data(), bytes.size(), &size);
        }
        if (result == HH_OK) {
            bytes.resize(size);
        }
        return result;
    }
    // Returns to a saved state. Changes nothing if the bytes are damaged or were saved with other
    // shapes.
    Status restore(std::span<const std::byte> bytes) {
        return hh_world_restore(world_, bytes.data(), bytes.size());
    }
    // Hash of the whole state, equal on every machine; 0 for an invalid world.
    std::uint64_t hash() const {
        std::uint64_t hash = 0;
        return hh_world_hash(world_, &hash) == HH_OK ? hash : 0;
    }
    // Hash of the simulated state alone: equal whichever steps were shown; 0 for an invalid world.
    std::uint64_t simulated_hash() const {
        std::uint64_t hash = 0;
        return hh_world_simulated_hash(world_, &hash) == HH_OK ? hash : 0;
    }

    // Sets all numbers from JSON; those that it lacks get their defaults.
    Status load_tuning(std::string_view json) {
        return hh_world_load_tuning(world_, json.data(), json.size());
    }
    // All numbers of the tuning, in the order of hh_tuning_describe; a vector is three.
    std::vector<double> tuning_numbers() const { return all<double>(&hh_world_tuning_numbers); }
    // Replaces all numbers of the tuning, in that order; on an error none changes.
    Status set_tuning_numbers(std::span<const double> numbers) {
        return hh_world_set_tuning_numbers(world_, numbers.data(), numbers.size());
    }
    // Replaces the additive clips of all players. Empty: none.
    Status load_body_clips(std::string_view json) {
        return hh_world_load_body_clips(world_, json.empty() ? nullptr : json.data(), json.size());
    }
    // Sets one number between steps. `name` is null-terminated.
    Status tune(const char* name, double value) {
        return hh_world_set_tuning(world_, name, &value, 1);
    }
    // A vector of the tuning.
    Maybe<Vec3> tuning_vector(const char* name) const {
        double v[3] = {};
        const hh_result result = hh_world_get_tuning(world_, name, v, 3);
        return {result, {v[0], v[1], v[2]}};
    }
    // One number. `name` is null-terminated.
    Maybe<double> tuning(const char* name) const {
        return make<double>([&](double* v) { return hh_world_get_tuning(world_, name, v, 1); });
    }
};

}  // namespace hh
