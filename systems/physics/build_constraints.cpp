#include "systems/physics/build_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/hand_indices.hpp"
#include "components/play_space.hpp"
#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/model/drive_pair.hpp"
#include "systems/physics/shared/mass_shares.hpp"

namespace handhold {
namespace {

void write_player(const BuildConstraintsIo& io, Entity player, const HeadTuning& tuning,
                  SolverBody& out) {
    out.role = BodyRole::translating;
    out.pose_ws = io.origin.at(player).pose_ws;
    out.velocity_mps = io.player_velocity.at(player).linear_mps;
    out.mass_kg = io.player.at(player).mass_kg;
    out.restitution = tuning.restitution;
    out.friction = tuning.friction;
    out.collider_offset_bs = head_center_ps(io.head.at(player), io.origin.at(player).scale, tuning);
}

void write_rigid(const BuildConstraintsIo& io, Entity entity, const RigidBody& body,
                 const PhaseTuning& tuning, SolverBody& out) {
    const BodyVelocity& velocity = io.body_velocity.at(entity);
    out.pose_ws = io.body_pose.at(entity).pose_ws;
    out.velocity_mps = velocity.linear_mps;
    out.spin_radps = velocity.angular_radps;
    out.restitution = body.restitution;
    out.friction = body.friction;
    out.role = role_of(body, tuning);
    if (out.role != BodyRole::fixed) {
        out.mass_kg = body.mass_kg;
        out.inertia_kgm2 = body.inertia_kgm2;
    }
}

void write_bodies(const BuildConstraintsIo& io, const Tuning& tuning) {
    FrameGraph& frame = io.frame;
    // heavy_body_kg decides which bodies are heavy: if it has changed, all bodies are processed.
    frame.active.all_changed |= frame.heavy_body_kg != tuning.phases.heavy_body_kg;
    frame.heavy_body_kg = tuning.phases.heavy_body_kg;
    frame.active.start_frame(frame.entities.size());
    frame.graph.bodies.resize(frame.entities.size());
    frame.phase.resize(frame.entities.size());
    frame.body_of_element.resize(io.body.size());
    for (const std::uint32_t i : frame.active.list) {
        const Entity entity = frame.entities[i];
        const std::size_t index = io.body.find_index(entity);
        SolverBody& body = frame.graph.bodies[i];
        body = {};
        body.id = frame.proxies[i].id;
        if (index == Column<RigidBody>::k_npos) {
            write_player(io, entity, tuning.head, body);
        } else {
            frame.body_of_element[index] = i;
            write_rigid(io, entity, io.body.elements()[index], tuning.phases, body);
        }
        frame.phase[i] = {};
        frame.phase[i].reached_ws = body.pose_ws;
    }
}

RowBlock hand_block(const Grab& grab, const Quat& play_space, std::uint64_t hand_id) {
    RowBlock block;
    const bool welded = grab.kind == GripKind::held && !grab.jointed;
    block.kind = welded ? RowKind::drive_weld : RowKind::drive_point;
    block.key = hand_id;
    block.point_a_bs = grab.target_ps.position;
    block.point_b_bs = grab.anchor_bs.position;
    block.rotation_a_bs = grab.target_ps.rotation;
    block.rotation_b_bs = grab.anchor_bs.rotation;
    block.drive_velocity_ws_mps = play_space * grab.target_velocity_ps_mps;
    block.drive_spin_ws_radps = play_space * grab.target_spin_ps_radps;
    return block;
}

// Completes the block of a hand that grips a player's head, or the part that `hold` names. The
// solver moves the gripped player's play space, so the anchor is given in that play space. The
// motion of the head or part within the play space is subtracted from the drive velocity.
void hold_player(const Grab& grab, const HeadTracking& head, const BodyHold* hold,
                 const Quat& play_space, double dt_s, RowBlock& block) {
    const Pose& start_ps = hold != nullptr ? hold->start_ps : head.start_ps;
    const Pose anchor_ps = (hold != nullptr ? hold->pose_ps : head.pose_ps) * grab.anchor_bs;
    const Vec3 displacement =
        anchor_ps.position - transform_point(start_ps, grab.anchor_bs.position);
    block.point_b_bs = anchor_ps.position;
    block.rotation_b_bs = anchor_ps.rotation;
    block.drive_velocity_ws_mps -= play_space * (displacement / dt_s);
}

// The hand's target at the start of the frame, from its mean velocity.
Pose target_before(const Grab& grab, double dt_s) {
    return {grab.target_ps.position - dt_s * grab.target_velocity_ps_mps,
            (rotation_from_vector(-dt_s * grab.target_spin_ps_radps) * grab.target_ps.rotation)
                .normalized()};
}

// Two-handed hold: the second hand's block controls the body's rotation. Its target and rate follow
// from both hands. The block keeps the second hand's points to measure how far that hand slid along
// the line between the hands.
void set_direction(const Grab& first, const Grab& second, const SolverBody& player,
                   const SolverBody& body, double dt_s, RowBlock& block) {
    const Quat near = player.pose_ws.rotation.conjugate() * body.pose_ws.rotation;
    const Quat now = rotation_from_drive_pair(
        {first.target_ps, second.target_ps, first.anchor_bs, second.anchor_bs}, near);
    const Quat before =
        rotation_from_drive_pair({target_before(first, dt_s), target_before(second, dt_s),
                                  first.anchor_bs, second.anchor_bs},
                                 now);
    block.kind = RowKind::drive_direction;
    block.rotation_a_bs = now;
    block.rotation_b_bs = Quat::Identity();
    block.drive_spin_ws_radps =
        player.pose_ws.rotation * (rotation_to_vector(now * before.conjugate()) / dt_s);
}

// Splits the rows between two hands that hold one free body: the first holds its point, the second
// its direction. If the hands are too close for that, the first has all rows. Returns false if this
// hand has no rows.
bool share_rows(const BuildConstraintsIo& io, std::size_t index, RowBlock& block) {
    const std::size_t other = find_other_hand(io.owner, io.grab, index);
    const Grab& grab = io.grab.elements()[index];
    if (other == io.grab.size() || !share_free_body(grab, io.grab.elements()[other])) {
        return true;
    }
    if (is_first_hand(io.owner, io.grab, index, other)) {
        block.kind = grab.two_handed ? RowKind::drive_point : block.kind;
        return true;
    }
    if (grab.two_handed) {
        const std::vector<SolverBody>& bodies = io.frame.graph.bodies;
        set_direction(io.grab.elements()[other], grab, bodies[block.a], bodies[block.b], io.dt_s,
                      block);
    }
    return grab.two_handed;
}

void write_hands(const BuildConstraintsIo& io, const PhaseTuning& tuning) {
    FrameGraph& frame = io.frame;
    frame.hand_blocks.clear();
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        const Entity hand = io.grab.owners()[index];
        const Entity player = io.owner.at(hand).player;
        if (grab.kind == GripKind::none) {
            continue;
        }
        const std::size_t a = find_body(frame.graph, io.persistent_id.at(player).value);
        const std::size_t b = find_body(frame.graph, io.persistent_id.at(grab.body).value);
        if (a == frame.graph.bodies.size() || b == frame.graph.bodies.size()) {
            continue;  // the gripped body was destroyed
        }
        RowBlock block = hand_block(grab, frame.graph.bodies[a].pose_ws.rotation,
                                    io.persistent_id.at(hand).value);
        block.a = static_cast<std::uint32_t>(a);
        block.b = static_cast<std::uint32_t>(b);
        block.source = static_cast<std::uint32_t>(index);
        if (grab.kind == GripKind::player) {
            const BodyHold* const hold = io.body_hold.find(hand);
            hold_player(grab, io.head.at(grab.body), hold, frame.graph.bodies[b].pose_ws.rotation,
                        io.dt_s, block);
        }
        if (!share_rows(io, index, block)) {
            continue;
        }
        frame.hand_blocks.push_back(block);
        note_grip(grab, a, b, tuning, frame);
    }
}

// Index of the solver body that stands for the world, added when the first joint needs it. Its id
// is the largest, so it is last.
std::size_t world_body(FrameGraph& frame) {
    constexpr std::uint64_t k_world_id = std::numeric_limits<std::uint64_t>::max();
    std::vector<SolverBody>& bodies = frame.graph.bodies;
    if (bodies.empty() || bodies.back().id != k_world_id) {
        bodies.emplace_back().id = k_world_id;
        frame.phase.emplace_back();
    }
    return bodies.size() - 1;
}

RowKind row_kind(JointKind kind) {
    switch (kind) {
        case JointKind::ball:
            return RowKind::ball;
        case JointKind::hinge:
            return RowKind::hinge;
        case JointKind::slider:
            return RowKind::slider;
        case JointKind::fixed:
            return RowKind::fixed;
        case JointKind::distance:
            break;
    }
    return RowKind::distance;
}

// Time constant of detents. A detent drives its joint towards the nearest multiple of its spacing,
// at most so fast that the joint gets there in this time.
constexpr double k_detent_s = 0.05;

void write_joint_rows(const Joint& joint, const JointState& state, double dt_s, JointRows& rows) {
    rows.limited = joint.limited || joint.kind == JointKind::distance;
    rows.lower = joint.lower;
    rows.upper = joint.upper;
    // Uses the predicted angle, because the joint may rotate fast.
    rows.previous = state.coordinate + state.speed * dt_s;
    rows.friction_impulse = joint.friction * dt_s;
    rows.motor_target = rows.motor_time_s = rows.motor_speed = 0.0;
    rows.motor_frame_s = rows.motor_max_impulse = 0.0;
    rows.lock_limit_impulse = rows.lock_impulse = 0.0;
    if (joint.motor.kind != MotorKind::none) {
        rows.motor_max_impulse = joint.motor.strength * dt_s;
        rows.motor_frame_s = dt_s;
        if (joint.motor.kind == MotorKind::speed) {
            rows.motor_speed = joint.motor.speed;
        } else {
            rows.motor_target = joint.motor.position;
            rows.motor_time_s = std::max(joint.motor.time_s, dt_s);
        }
    } else if (joint.detent_spacing > 0.0) {
        rows.motor_target =
            joint.detent_spacing * std::round(state.coordinate / joint.detent_spacing);
        rows.motor_time_s = std::max(k_detent_s, dt_s);
        rows.motor_max_impulse = joint.detent_strength * dt_s;
    }
    if (state.latched) {
        rows.limited = true;
        rows.lower = joint.latch.at;
        rows.upper = joint.latch.at;
        rows.lock_limit_impulse = joint.latch.strength * dt_s;
    }
}

// Writes a joint's block. False if it connects no movable body, or a body was destroyed.
bool write_joint(const BuildConstraintsIo& io, std::size_t index, RowBlock& block) {
    ConstraintGraph& graph = io.frame.graph;
    const auto body_index = [&](Entity entity) {
        const std::size_t body = io.body.find_index(entity);
        return body != Column<RigidBody>::k_npos ? std::size_t{io.frame.body_of_element[body]}
                                                 : graph.bodies.size();
    };
    const auto is_movable = [&](std::size_t body) {
        return graph.bodies[body].role != BodyRole::fixed;
    };
    const Joint& joint = io.joint.elements()[index];
    const Entity entity = io.joint.owners()[index];
    const std::size_t b = body_index(joint.b);
    const std::size_t a = is_null(joint.a) ? world_body(io.frame) : body_index(joint.a);
    if (a >= graph.bodies.size() || b >= graph.bodies.size() || !(is_movable(a) || is_movable(b))) {
        return false;
    }
    block.kind = row_kind(joint.kind);
    block.key = io.persistent_id.at(entity).value;
    block.source = static_cast<std::uint32_t>(index);
    block.a = static_cast<std::uint32_t>(a);
    block.b = static_cast<std::uint32_t>(b);
    block.point_a_bs = joint.frame_a_bs.position;
    block.point_b_bs = joint.frame_b_bs.position;
    block.rotation_a_bs = joint.frame_a_bs.rotation;
    block.rotation_b_bs = joint.frame_b_bs.rotation;
    write_joint_rows(joint, io.joint_state.at(entity), io.dt_s, block.joint);
    block.impulse_ws_ns.setZero();
    block.angular_impulse_ws_nms.setZero();
    return true;
}

// rewrite_joints and rewrite_hands overwrite the blocks of the last frame in place. Blocks are
// sorted by island, and stay sorted as long as the joints and grips are the same. Returns false if
// the set of joints, or of hand blocks, has changed.
bool rewrite_joints(const BuildConstraintsIo& io) {
    std::size_t rewritten = 0;
    for (RowBlock& block : io.frame.graph.blocks) {
        if (!is_joint(block)) {
            continue;
        }
        if (block.source >= io.joint.size() || !write_joint(io, block.source, block)) {
            return false;
        }
        ++rewritten;
    }
    // Each block has a different source, so equal counts mean that all joints were rewritten.
    return rewritten == io.joint.size();
}
bool rewrite_hands(FrameGraph& frame) {
    std::size_t rewritten = 0;
    for (RowBlock& block : frame.graph.blocks) {
        if (!is_drive(block)) {
            continue;
        }
        const auto now = std::ranges::lower_bound(frame.hand_blocks, block.source, {},
                                                  [](const RowBlock& hand) { return hand.source; });
        if (now == frame.hand_blocks.end() || now->source != block.source ||
            now->key != block.key || now->kind != block.kind) {
            return false;
        }
        block = *now;
        ++rewritten;
    }
    return rewritten == frame.hand_blocks.size();
}

void write_joints(const BuildConstraintsIo& io) {
    if (rewrite_joints(io)) {
        return;
    }
    std::vector<RowBlock>& blocks = io.frame.graph.blocks;
    blocks.clear();
    for (std::size_t index = 0; index < io.joint.size(); ++index) {
        if (!write_joint(io, index, blocks.emplace_back())) {
            blocks.pop_back();
        }
    }
}

void place_hands(FrameGraph& frame) {
    if (rewrite_hands(frame)) {
        return;
    }
    std::vector<RowBlock>& blocks = frame.graph.blocks;
    std::erase_if(blocks, [](const RowBlock& block) { return is_drive(block); });
    blocks.insert(blocks.end(), frame.hand_blocks.begin(), frame.hand_blocks.end());
}

// Bodies that joints connect to a held body count as held.
void propagate_held(const BuildConstraintsIo& io) {
    const JointGroups& groups = io.frame.joint_groups;
    if (groups.of_body.empty()) {
        return;
    }
    for (const Grab& grab : io.grab.elements()) {
        const std::size_t held = io.body.find_index(grab.body);
        if (grab.kind != GripKind::held || held == Column<RigidBody>::k_npos) {
            continue;
        }
        for (const Joint& joint : io.joint.elements()) {
            for (const Entity entity : {joint.a, joint.b}) {
                const std::size_t index = io.body.find_index(entity);
                if (index != Column<RigidBody>::k_npos && groups.share_group(index, held)) {
                    io.frame.phase[io.frame.body_of_element[index]].held = true;
                }
            }
        }
    }
}

}  // namespace

void build_constraints(const BuildConstraintsIo& io, const Tuning& tuning) {
    write_bodies(io, tuning);
    write_joints(io);
    write_hands(io, tuning.phases);
    place_hands(io.frame);
    propagate_held(io);
    replace_contact_rows(io.frame.contacts, io.frame.graph);
}

}  // namespace handhold
