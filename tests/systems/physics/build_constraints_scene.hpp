#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "systems/physics/build_constraints.hpp"
#include "tests/systems/frame/column_scene.hpp"

// The columns of one player with two hands, and bodies, for the tests of build_constraints.
namespace handhold::test {

inline constexpr Entity k_rock = entity(4);

// Ids descend with the slots, so that ordering by slot would be noticed.
inline std::uint64_t id_of(Entity entity) { return 100 - std::uint64_t{entity.slot}; }

struct Building {
    Column<PersistentId> persistent_id;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    Column<BodyVelocity> body_velocity;
    Column<Joint> joint;
    Column<JointState> joint_state;
    Column<PlayerBody> player;
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> player_velocity;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    FrameGraph frame;
    Tuning tuning;

    explicit Building(std::initializer_list<Entity> hands = {k_left, k_right}) {
        persistent_id.add(k_player, {id_of(k_player)});
        player.add(k_player, {70.0});
        origin.add(k_player);
        player_velocity.add(k_player);
        head.add(k_player);
        for (const Entity entity : hands) {
            persistent_id.add(entity, {id_of(entity)});
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            grab.add(entity);
        }
        add_collider(k_player);
    }
    // In the order of place_colliders.
    void add_collider(Entity entity) {
        frame.entities.push_back(entity);
        std::sort(frame.entities.begin(), frame.entities.end(),
                  [](Entity x, Entity y) { return id_of(x) < id_of(y); });
        frame.proxies.clear();
        for (const Entity listed : frame.entities) {
            frame.proxies.emplace_back().id = id_of(listed);
        }
    }
    void add_body(Entity entity, const RigidBody& rigid, const Pose& pose = {},
                  const BodyVelocity& velocity = {}) {
        persistent_id.add(entity, {id_of(entity)});
        body.add(entity, rigid);
        body_pose.add(entity, {pose});
        body_velocity.add(entity, velocity);
        add_collider(entity);
    }
    void add_rock(double mass_kg) {
        add_body(k_rock, {BodyKind::free, mass_kg, Vec3(0.1, 0.2, 0.3), 0.5});
    }
    Grab& grip(Entity hand, GripKind kind, Entity gripped, Random& random) {
        Grab& grip = grab.at(hand);
        grip.kind = kind;
        grip.phase = GrabPhase::holding;
        grip.body = gripped;
        grip.anchor_bs = random.pose();
        grip.target_ps = random.pose();
        grip.target_velocity_ps_mps = random.vector(2.0);
        grip.target_spin_ps_radps = random.vector(2.0);
        return grip;
    }
    void run() {
        build_constraints({.dt_s = 1.0 / 90.0,
                           .persistent_id = persistent_id,
                           .body = body,
                           .body_pose = body_pose,
                           .body_velocity = body_velocity,
                           .joint = joint,
                           .joint_state = joint_state,
                           .player = player,
                           .origin = origin,
                           .player_velocity = player_velocity,
                           .head = head,
                           .owner = owner,
                           .grab = grab,
                           .body_hold = body_hold,
                           .frame = frame},
                          tuning);
    }
    std::uint32_t index_of_body(Entity entity) const {
        return static_cast<std::uint32_t>(find_body(frame.graph, id_of(entity)));
    }
    const SolverBody& solver_body(Entity entity) const {
        return frame.graph.bodies[index_of_body(entity)];
    }
    const FrameGraph::PhaseBody& phase(Entity entity) const {
        return frame.phase[index_of_body(entity)];
    }
};

}  // namespace handhold::test
