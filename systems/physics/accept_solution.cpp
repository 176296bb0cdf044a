#include "systems/physics/accept_solution.hpp"

#include <algorithm>

#include "engine/solver/model/collider_pose.hpp"

namespace handhold {
namespace {

void write_solved_player(const AcceptSolutionIo& io, Entity player, SolverBody& body) {
    const auto solved = std::ranges::find(io.players, player, &SolvedPlayer::player);
    const Vec3 predicted_ws = body.pose_ws.position;
    if (solved != io.players.end()) {
        body.pose_ws.position = solved->origin_ws;
        body.velocity_mps = solved->velocity_mps;
    }
    io.origin.at(player).pose_ws.position = body.pose_ws.position;
    io.velocity.at(player).linear_mps = body.velocity_mps;
    io.frame.push_backs.push_back({player, (body.pose_ws.position - predicted_ws).norm()});
}

void write_solved_bodies(const AcceptSolutionIo& io) {
    FrameGraph& frame = io.frame;
    frame.push_backs.clear();
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
        SolverBody& body = frame.graph.bodies[i];
        const Entity entity = frame.entities[i];
        frame.phase[i].velocity_before_mps = body.velocity_mps;
        if (body.role == BodyRole::translating) {
            write_solved_player(io, entity, body);
        } else {
            body.pose_ws = io.body_pose.at(entity).pose_ws;
            body.velocity_mps = io.body_velocity.at(entity).linear_mps;
            body.spin_radps = io.body_velocity.at(entity).angular_radps;
        }
        if (LastValidPose* const valid = io.last_valid.find(entity)) {
            // A head that was never tracked has no valid pose: its proxy's pose is invalid.
            *valid = {collider_pose(body), is_valid(frame.proxies[i].to_ws)};
        }
    }
}

// Writes the velocity at the release: that of the body if the hand held it, else that of the
// player.
void throw_released(const AcceptSolutionIo& io, const RowBlock& block, bool is_welded) {
    SolverBody& player = io.frame.graph.bodies[block.a];
    SolverBody& body = io.frame.graph.bodies[block.b];
    const Vec3 arm_ws = body.pose_ws.rotation * block.point_b_bs;
    if (is_welded) {
        body.spin_radps = block.drive_spin_ws_radps;
        body.velocity_mps =
            player.velocity_mps + block.drive_velocity_ws_mps - body.spin_radps.cross(arm_ws);
        io.body_velocity.at(io.frame.entities[block.b]) = {body.velocity_mps, body.spin_radps};
    } else {
        player.velocity_mps =
            body.velocity_mps + body.spin_radps.cross(arm_ws) - block.drive_velocity_ws_mps;
        io.velocity.at(io.frame.entities[block.a]).linear_mps = player.velocity_mps;
    }
}

}  // namespace

double accept_solution(const AcceptSolutionIo& io) {
    write_solved_bodies(io);
    for (Grab& grab : io.grab.elements()) {
        grab.error_m = 0.0;
    }
    double worst_m = 0.0;
    for (const RowBlock& block : io.frame.graph.blocks) {
        if (!is_drive(block)) {
            continue;
        }
        RowBlock point = block;
        point.kind = RowKind::drive_point;
        Grab& grab = io.grab.elements()[block.source];
        grab.error_m = block_error_m(io.frame.graph.bodies, point);
        worst_m = std::max(worst_m, grab.error_m);
        // The host's solver may have pushed or pulled the player through this grip.
        io.frame.phase[block.a].pushed = true;
        const bool is_free_again = grab.phase == GrabPhase::releasing && !grab.jointed &&
                                   grab.kind != GripKind::player && !grab.two_handed;
        if (is_free_again && grab.error_m <= k_follows_m) {
            throw_released(io, block, grab.kind == GripKind::held);
        }
    }
    return worst_m;
}

}  // namespace handhold
