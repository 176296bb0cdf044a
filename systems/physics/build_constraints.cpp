#include "systems/physics/build_constraints.hpp"

#include <algorithm>

#include "components/play_space.hpp"
#include "engine/solver/contact_rows.hpp"

namespace handhold {
namespace {

SolverBody player_body(const BuildConstraintsIo& io, Entity player, const HeadTuning& tuning) {
    SolverBody out;
    out.role = BodyRole::player;
    out.pose_ws = io.origin.at(player).pose_ws;
    out.velocity_mps = io.player_velocity.at(player).linear_mps;
    out.mass_kg = io.player.at(player).mass_kg;
    out.restitution = tuning.restitution;
    out.collider_offset_bs = head_center_ps(io.head.at(player), tuning);
    return out;
}

SolverBody rigid_body(const BuildConstraintsIo& io, Entity entity, const PhaseTuning& tuning) {
    SolverBody out;
    const RigidBody& body = io.body.at(entity);
    out.pose_ws = io.body_pose.at(entity).pose_ws;
    out.velocity_mps = io.body_velocity.at(entity).linear_mps;
    out.restitution = body.restitution;
    out.spin_radps = io.body_velocity.at(entity).angular_radps;
    if (body.kind == BodyKind::free) {
        out.role = body.mass_kg >= tuning.heavy_body_kg ? BodyRole::heavy : BodyRole::free;
        out.mass_kg = body.mass_kg;
        out.inertia_kgm2 = body.inertia_kgm2;
    }
    return out;
}

void add_bodies(const BuildConstraintsIo& io, const Tuning& tuning) {
    FrameGraph& frame = io.frame;
    frame.graph.bodies.clear();
    frame.phase.assign(frame.entities.size(), {});
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
        const Entity entity = frame.entities[i];
        SolverBody body = io.player.contains(entity) ? player_body(io, entity, tuning.head)
                                                     : rigid_body(io, entity, tuning.phases);
        body.id = frame.proxies[i].id;
        frame.graph.bodies.push_back(body);
    }
}

RowBlock hand_block(const Grab& grab, const Quat& play_space, std::uint64_t hand_id) {
    RowBlock block;
    block.kind = grab.kind == GripKind::held ? RowKind::hand_weld : RowKind::hand_point;
    block.key = hand_id;
    block.point_a_bs = grab.target_ps.position;
    block.point_b_bs = grab.anchor_bs.position;
    block.rotation_a_bs = grab.target_ps.rotation;
    block.rotation_b_bs = grab.anchor_bs.rotation;
    block.drive_velocity_ws_mps = play_space * grab.target_velocity_ps_mps;
    block.drive_spin_ws_radps = play_space * grab.target_spin_ps_radps;
    return block;
}

void add_hands(const BuildConstraintsIo& io, const PhaseTuning& tuning) {
    FrameGraph& frame = io.frame;
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const Grab& grab = io.grab.rows()[row];
        const Entity hand = io.grab.owners()[row];
        const Entity player = io.owner.at(hand).player;
        if (grab.kind == GripKind::none) {
            continue;
        }
        const std::size_t a = find_body(frame.graph, io.persistent_id.at(player).value);
        const std::size_t b = find_body(frame.graph, io.persistent_id.at(grab.body).value);
        if (a == frame.graph.bodies.size() || b == frame.graph.bodies.size()) {
            continue;  // a body whose collider was taken away holds nothing
        }
        RowBlock block = hand_block(grab, frame.graph.bodies[a].pose_ws.rotation,
                                    io.persistent_id.at(hand).value);
        block.a = static_cast<std::uint32_t>(a);
        block.b = static_cast<std::uint32_t>(b);
        frame.graph.blocks.push_back(block);
        if (grab.kind == GripKind::held) {
            // 1/kappa: 0 for what is light, 1 where momentum is exchanged exactly. The heaviest
            // thing held counts.
            const double share =
                smooth_step(frame.graph.bodies[b].mass_kg, tuning.kappa_light_kg,
                            std::max(tuning.kappa_heavy_kg, tuning.kappa_light_kg + 1e-9));
            frame.phase[a].forward_share = std::max(frame.phase[a].forward_share, share);
            frame.phase[b].held = true;
        } else {
            frame.phase[a].grips_surface = true;
        }
    }
}

}  // namespace

void build_constraints(const BuildConstraintsIo& io, const Tuning& tuning) {
    io.frame.graph.blocks.clear();
    add_bodies(io, tuning);
    add_hands(io, tuning.phases);
    replace_contact_rows(io.frame.contacts, io.frame.graph);
}

}  // namespace handhold
