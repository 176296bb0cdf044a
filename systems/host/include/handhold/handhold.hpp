#pragma once

// Handhold in C++20: a thin wrapper over handhold.h. Header only; needs neither exceptions nor RTTI
// nor Eigen. Ids, definitions and outputs are those of handhold.h, whose comments hold here too;
// this header adds ownership, spans and defaults.
//
// Calls return Status, which converts to true on success, or Maybe<T>, which has a value on
// success. Neither may be ignored.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <handhold/values.hpp>

namespace hh {

// A world and everything in it. After a failed construction is_valid is false and every call fails
// with HH_ERROR_NULL.
class World {
  public:
    World() : World(world_def()) {}
    // Makes an empty world. Check is_valid().
    explicit World(const hh_world_def& def) {
        if (hh_world_create(&def, &world_) != HH_OK) {
            world_ = nullptr;
        }
    }
    ~World() { hh_world_destroy(world_); }
    // Takes over the world; `other` is empty afterwards.
    World(World&& other) noexcept : world_(std::exchange(other.world_, nullptr)) {}
    // Exchanges the two.
    World& operator=(World&& other) noexcept {
        std::swap(world_, other.world_);
        return *this;
    }
    // True unless creation failed or the world was moved from.
    bool is_valid() const { return world_ != nullptr; }
    // The handle of the C interface; null if not valid.
    hh_world* get() { return world_; }
    // The handle of the C interface; null if not valid.
    const hh_world* get() const { return world_; }

    // ---- Level: shapes, bodies, joints. ----

    // A box of twice these lengths.
    Maybe<Shape> add_box(Vec3 half_extents_m) {
        return make<Shape>([&](Shape* s) { return hh_shape_add_box(world_, half_extents_m, s); });
    }
    // A sphere about the shape's origin.
    Maybe<Shape> add_sphere(double radius_m) {
        return make<Shape>([&](Shape* s) { return hh_shape_add_sphere(world_, radius_m, s); });
    }
    // A capsule along Y. half_height_m does not count the caps.
    Maybe<Shape> add_capsule(double radius_m, double half_height_m) {
        return make<Shape>(
            [&](Shape* s) { return hh_shape_add_capsule(world_, radius_m, half_height_m, s); });
    }
    // A cylinder along Y.
    Maybe<Shape> add_cylinder(double radius_m, double half_height_m) {
        return make<Shape>(
            [&](Shape* s) { return hh_shape_add_cylinder(world_, radius_m, half_height_m, s); });
    }
    // The convex hull of points that are not coplanar.
    Maybe<Shape> add_hull(std::span<const Vec3> points) {
        return make<Shape>(
            [&](Shape* s) { return hh_shape_add_hull(world_, points.data(), points.size(), s); });
    }
    // Parts that move as one. It keeps copies: the parts may be removed.
    Maybe<Shape> add_compound(std::span<const hh_compound_part> parts) {
        return make<Shape>(
            [&](Shape* s) { return hh_shape_add_compound(world_, parts.data(), parts.size(), s); });
    }
    // Triangles for static and kinematic bodies. A scale other than 1 prepares the hands' surface
    // again.
    Maybe<Shape> add_mesh(const Mesh& mesh, Vec3 scale = {1.0, 1.0, 1.0}) {
        return make<Shape>(
            [&](Shape* s) { return hh_shape_add_mesh(world_, mesh.get(), scale, s); });
    }
    // Fails while a body or a player has the shape.
    Status remove(Shape shape) { return hh_shape_remove(world_, shape); }

    // Adds a body at its pose.
    Maybe<Body> add(const hh_body_def& def) {
        return make<Body>([&](Body* b) { return hh_body_add(world_, &def, b); });
    }
    // Joins two bodies where they are now.
    Maybe<Joint> add(const hh_joint_def& def) {
        return make<Joint>([&](Joint* j) { return hh_joint_add(world_, &def, j); });
    }
    // Adds a player with two hands, which are open until tracking says otherwise.
    Maybe<Player> add(const hh_player_def& def) {
        return make<Player>([&](Player* p) { return hh_player_add(world_, &def, p); });
    }
    // Removes a body with its joints. Hands that grip it are empty at once.
    Status remove(Body body) { return hh_body_remove(world_, body); }
    // Removes a joint; its bodies stay.
    Status remove(Joint joint) { return hh_joint_remove(world_, joint); }
    // Removes a player and both hands.
    Status remove(Player player) { return hh_player_remove(world_, player); }
    // True if the shape is in this world.
    bool has(Shape shape) const { return hh_shape_is_valid(world_, shape); }
    // True if the body is in this world.
    bool has(Body body) const { return hh_body_is_valid(world_, body); }
    // True if the joint is in this world.
    bool has(Joint joint) const { return hh_joint_is_valid(world_, joint); }
    // True if the player is in this world.
    bool has(Player player) const { return hh_player_is_valid(world_, player); }
    // The body with this name. `name` is null-terminated.
    Maybe<Body> find_body(const char* name) const {
        return make<Body>([&](Body* b) { return hh_body_find(world_, name, b); });
    }

    // ---- Bodies ----

    // Where the body is: its shape's own frame, in the world.
    Maybe<Pose> pose(Body body) const {
        return make<Pose>([&](Pose* p) { return hh_body_pose(world_, body, p); });
    }
    // Poses of many bodies; none is written if an id is stale. `poses` is at least as long as
    // `bodies`.
    Status poses(std::span<const Body> bodies, std::span<Pose> poses) const {
        return poses.size() < bodies.size()
                   ? HH_ERROR_CAPACITY
                   : hh_world_body_poses(world_, bodies.data(), bodies.size(), poses.data());
    }
    // A body's velocity in the world.
    struct Motion {
        // Velocity of the centre of mass.
        Vec3 velocity_mps;
        // About the world's axes.
        Vec3 angular_velocity_radps;
    };
    // The body's velocity after the last step.
    Maybe<Motion> motion(Body body) const {
        return make<Motion>([&](Motion* m) {
            return hh_body_velocity(world_, body, &m->velocity_mps, &m->angular_velocity_radps);
        });
    }
    // Static, kinematic or dynamic.
    Maybe<hh_body_kind> kind(Body body) const {
        return make<hh_body_kind>(
            [&](hh_body_kind* k) { return hh_body_get_kind(world_, body, k); });
    }
    // The mass of a dynamic body; 0 for others.
    Maybe<double> mass_kg(Body body) const {
        return make<double>([&](double* m) { return hh_body_mass(world_, body, m); });
    }
    // Friction and restitution of a body.
    struct Material {
        // Coulomb coefficient, [0, 1e6]: a contact uses the geometric mean of both bodies' values.
        double friction;
        // [0, 1]: a contact uses the larger of both bodies' values.
        double restitution;
    };
    // The body's material.
    Maybe<Material> material(Body body) const {
        return make<Material>([&](Material* m) {
            return hh_body_material(world_, body, &m->friction, &m->restitution);
        });
    }
    // Changes the body's material. Grips stay.
    Status set_material(Body body, const Material& material) {
        return hh_body_set_material(world_, body, material.friction, material.restitution);
    }
    // Changes a dynamic body's mass. Inertia 0: of its solid shape. Grips stay.
    Status set_mass(Body body, double mass_kg, Vec3 inertia_kgm2 = {}) {
        return hh_body_set_mass(world_, body, mass_kg, inertia_kgm2);
    }
    // Makes a body static, kinematic or dynamic where it is. Grips stay. Mass and inertia: of a
    // body that becomes dynamic.
    Status set_kind(Body body, hh_body_kind kind, double mass_kg = 1.0, Vec3 inertia_kgm2 = {}) {
        return hh_body_set_kind(world_, body, kind, mass_kg, inertia_kgm2);
    }
    // The body's shape; a null id: none.
    Maybe<Shape> shape(Body body) const {
        return make<Shape>([&](Shape* s) { return hh_body_shape(world_, body, s); });
    }
    // Changes the body's shape where it is. Hands that are too far from the new surface let go in
    // the next step.
    Status set_shape(Body body, Shape shape) { return hh_body_set_shape(world_, body, shape); }
    // Ids of all bodies.
    std::vector<Body> bodies() const { return all<Body>(&hh_world_bodies); }
    // Sets the velocity of a dynamic body's centre of mass, in the world.
    Status set_velocity(Body body, Vec3 linear_mps, Vec3 angular_radps = {}) {
        return hh_body_set_velocity(world_, body, linear_mps, angular_radps);
    }
    // Changes a dynamic body's velocity by an impulse at a point in the world.
    Status apply_impulse(Body body, Vec3 impulse_ns, Vec3 point) {
        return hh_body_apply_impulse(world_, body, impulse_ns, point);
    }
    // Places a body at once and keeps its velocity. Hands that grip it let go.
    Status teleport(Body body, Pose pose) { return hh_body_teleport(world_, body, pose); }
    // A kinematic body reaches the pose at the end of the next step, and then rests.
    Status move_kinematic(Body body, Pose pose) {
        return hh_body_move_kinematic(world_, body, pose);
    }
    // Adds an authored grip, which hands that close near it take.
    Status add_grip(Body body, const hh_grip_def& def) {
        return hh_body_add_grip(world_, body, &def);
    }

    // The first surface on a segment. Queries return nullopt if nothing was found, or if the call
    // failed.
    std::optional<Hit> cast_ray(Vec3 from, Vec3 to, Player skip = {}) {
        Hit hit{};
        return found(hh_world_cast_ray(world_, from, to, skip, &hit), hit);
    }
    // The first impact of a sphere that moves along a segment.
    std::optional<Hit> cast_sphere(double radius_m, Vec3 from, Vec3 to, Player skip = {}) {
        Hit hit{};
        return found(hh_world_cast_sphere(world_, radius_m, from, to, skip, &hit), hit);
    }
    // The nearest surface point within a distance.
    std::optional<Hit> closest_point(Vec3 point, double max_distance_m, Player skip = {}) {
        Hit hit{};
        return found(hh_world_closest_point(world_, point, max_distance_m, skip, &hit), hit);
    }
    // Every body that a sphere touches. `hits` keeps its memory from call to call.
    Status overlap_sphere(Vec3 center, double radius_m, std::vector<Hit>& hits, Player skip = {}) {
        std::size_t count = 0;
        hits.resize(std::max<std::size_t>(hits.capacity(), 8));
        hh_result result = hh_world_overlap_sphere(world_, center, radius_m, skip, hits.data(),
                                                   hits.size(), &count);
        if (result == HH_ERROR_CAPACITY) {
            hits.resize(count);
            result = hh_world_overlap_sphere(world_, center, radius_m, skip, hits.data(),
                                             hits.size(), &count);
        }
        hits.resize(result == HH_OK ? count : 0);
        return result;
    }

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

  private:
    static std::optional<Hit> found(hh_result result, const Hit& hit) {
        const bool is_hit = hit.body.generation != 0 || hit.player.generation != 0;
        return result == HH_OK && is_hit ? std::optional(hit) : std::nullopt;
    }
    template <typename T>
    std::vector<T> all(hh_result (*call)(const hh_world*, T*, std::size_t, std::size_t*)) const {
        std::size_t count = 0;
        std::vector<T> values;
        if (call(world_, nullptr, 0, &count) == HH_OK) {
            values.resize(count);
            values.resize(call(world_, values.data(), count, &count) == HH_OK ? count : 0);
        }
        return values;
    }
    template <typename T>
    std::span<const T> list(hh_result (*call)(const hh_world*, const T**, std::size_t*)) const {
        const T* first = nullptr;
        std::size_t count = 0;
        return call(world_, &first, &count) == HH_OK ? std::span(first, count)
                                                     : std::span<const T>();
    }
    template <typename T, typename Call>
    static Maybe<T> make(const Call& call) {
        T value{};
        const hh_result result = call(&value);
        return {result, value};
    }

    hh_world* world_ = nullptr;
};

}  // namespace hh
