#pragma once

// The calls of level.h, and adding and removing players.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <handhold/world_handle.hpp>

namespace hh {

// What a world consists of: shapes, bodies, joints and players. hh::World (handhold.hpp) has the
// other calls.
class Level : public WorldHandle {
  public:
    using WorldHandle::WorldHandle;

    // ---- Shapes, bodies, joints, players ----

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
    // Drives a hinge or slider from the next step on.
    Status set_motor(Joint joint, const hh_motor_def& motor) {
        return hh_joint_set_motor(world_, joint, &motor);
    }
    // New limits of a joint's coordinate; equal ones lock it.
    Status set_limits(Joint joint, double lower, double upper) {
        return hh_joint_set_limits(world_, joint, 1, lower, upper);
    }
    // A new latch at a coordinate; range 0: none.
    Status set_latch(Joint joint, double at, double range, double strength = 0.0) {
        return hh_joint_set_latch(world_, joint, at, range, strength);
    }
    // New friction of a joint.
    Status set_friction(Joint joint, double friction) {
        return hh_joint_set_friction(world_, joint, friction);
    }
    // Adds a static body for each node of a glTF file that has triangles; returns their number.
    Maybe<std::size_t> add_gltf_level(std::span<const std::byte> gltf, Pose pose = k_origin) {
        return make<std::size_t>([&](std::size_t* count) {
            return hh_world_add_gltf_level(world_, gltf.data(), gltf.size(), pose, nullptr, 0,
                                           count);
        });
    }
    // Writes the contacts of the last step and returns their number.
    Maybe<std::size_t> contacts(std::span<hh_contact> written) const {
        return make<std::size_t>([&](std::size_t* count) {
            return hh_world_contacts(world_, written.data(), written.size(), count);
        });
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
};

}  // namespace hh
