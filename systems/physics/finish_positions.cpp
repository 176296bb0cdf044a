#include "systems/physics/finish_positions.hpp"

#include <algorithm>
#include <optional>

#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/contact/moving_contacts.hpp"
#include "systems/physics/shared/restore_bodies.hpp"

namespace handhold {
namespace {

// --- Players who are pushed out ------------------------------------------------------------------

// Displacement of the head in this frame if no contact stops it, in world axes: the sum of the
// motions by grips, by the play space's velocity and by tracking.
Vec3 head_motion_m(const FinishPositionsIo& io, std::uint32_t player, const HeadTuning& tuning) {
    const Entity entity = io.frame.entities[player];
    const HeadTracking& head = io.head.at(entity);
    const auto& [predicted_ws, scale] = io.origin.at(entity);
    const Vec3 center_hs = scale * tuning.center_m;
    const Vec3 tracked_ps =
        transform_point(head.pose_ps, center_hs) - transform_point(head.start_ps, center_hs);
    const Vec3 gripped_m = io.frame.phase[player].reached_ws.position - predicted_ws.position;
    return predicted_ws.rotation * tracked_ps + io.dt_s * io.player_velocity.at(entity).linear_mps +
           gripped_m;
}

// The push of a wall on the head. `excess_m`: the part of the push along `normal` that is too
// large; above 0 only if the head was in the wall before this frame.
struct StuckIn {
    Vec3 normal = Vec3::Zero();
    double excess_m = 0.0;
};

// `motion_m`: head_motion_m. The approach of head and wall in this frame is undone in full. Older
// penetration is reduced by `eject_m` at most.
StuckIn stuck_in(const FinishPositionsIo& io, const RowBlock& block, const Vec3& motion_m,
                 double eject_m) {
    const FrameGraph& frame = io.frame;
    const Pose& wall_ws = frame.graph.bodies[block.b].pose_ws;
    const ColliderProxy& wall = frame.proxies[block.b];
    const Vec3 normal = wall_ws.rotation * block.normal_b_bs;
    const Vec3 wall_motion_m = transform_point(wall.to_ws, block.point_b_bs) -
                               transform_point(wall.from_ws, block.point_b_bs);
    const double allowed_m = std::max(0.0, normal.dot(wall_motion_m - motion_m)) + eject_m;
    const double depth_m =
        normal.dot(transform_point(wall_ws, block.point_b_bs) -
                   transform_point(frame.phase[block.a].reached_ws, block.point_a_bs));
    return {normal, depth_m - allowed_m};
}

// Limits the push on heads that are stuck in walls. Walls on both sides of a head contradict each
// other until the head is past the middle of one wall. The solver then finds a way out, which may
// be long, and the head takes it at a bounded speed.
void limit_pushes(const FinishPositionsIo& io, const HeadTuning& tuning) {
    FrameGraph& frame = io.frame;
    for (const std::uint32_t i : frame.active.list) {
        SolverBody& body = frame.graph.bodies[i];
        if (body.role != BodyRole::translating) {
            continue;
        }
        const Vec3& reached_m = frame.phase[i].reached_ws.position;
        Vec3 push_m = body.pose_ws.position - reached_m;
        const double eject_m = io.origin.at(frame.entities[i]).scale * k_head_eject_mps * io.dt_s;
        if (push_m.norm() <= eject_m) {
            continue;
        }
        const Vec3 motion_m = head_motion_m(io, i, tuning);
        StuckIn worst;
        for (const RowBlock& block : frame.graph.blocks) {
            if (is_contact(block) && block.a == i &&
                frame.graph.bodies[block.b].role == BodyRole::fixed) {
                const StuckIn found = stuck_in(io, block, motion_m, eject_m);
                worst = found.excess_m > worst.excess_m ? found : worst;
            }
        }
        const double along_m = worst.normal.dot(push_m);
        push_m -= worst.normal * std::clamp(along_m, 0.0, worst.excess_m);
        body.pose_ws.position = reached_m + push_m;
    }
}

// --- Results -------------------------------------------------------------------------------------

void write_poses(const FinishPositionsIo& io) {
    FrameGraph& frame = io.frame;
    frame.push_backs.clear();
    for (const std::uint32_t i : frame.active.list) {
        const SolverBody& body = frame.graph.bodies[i];
        if (body.role == BodyRole::fixed) {
            continue;
        }
        const Entity entity = frame.entities[i];
        if (body.role == BodyRole::translating) {
            io.origin.at(entity).pose_ws.position = body.pose_ws.position;
            frame.push_backs.push_back(
                {entity, (body.pose_ws.position - frame.phase[i].reached_ws.position).norm()});
        } else {
            io.body_pose.at(entity).pose_ws = body.pose_ws;
        }
    }
}

void write_hand_error(const FinishPositionsIo& io, const RowBlock& block, StageStats& stats) {
    RowBlock point = block;
    point.kind = RowKind::drive_point;
    const double error = block_error_m(io.frame.graph.bodies, point);
    stats.hand_error_m = std::max(stats.hand_error_m, error);
    io.grab.elements()[block.source].error_m = error;
}

void add_worst(const JointError& error, StageStats& stats) {
    stats.joint_error_m = std::max(stats.joint_error_m, error.point_m);
    stats.joint_error_rad = std::max(stats.joint_error_rad, error.angle_rad);
}

// The joint errors of the island's last solve, if that solve reported them and no body was restored
// since.
std::optional<JointError> cached_joint_error(const FrameGraph& frame, std::size_t island) {
    const bool is_cached = frame.penetrating_bodies.empty() && frame.island_errors[island];
    return is_cached ? frame.island_errors[island]->joints : std::nullopt;
}

void write_island_errors(const FinishPositionsIo& io, std::size_t island, StageStats& stats) {
    const ConstraintGraph& graph = io.frame.graph;
    const std::optional<JointError> cached = cached_joint_error(io.frame, island);
    add_worst(cached.value_or(JointError{}), stats);
    for (const std::uint32_t i : graph.blocks_of(graph.islands[island])) {
        const RowBlock& block = graph.blocks[i];
        if (is_drive(block)) {
            write_hand_error(io, block, stats);
        } else if (is_contact(block)) {
            const double overlap = block_error_m(graph.bodies, block);
            stats.residual_m = std::max(stats.residual_m, overlap);
            if (overlap > k_new_overlap_m) {
                stats.count(Fallback::contacts_unresolved);
            }
        } else if (!cached) {
            add_worst(joint_error(graph.bodies, block), stats);
        }
    }
}

void write_errors(const FinishPositionsIo& io, StageStats& stats) {
    for (Grab& grab : io.grab.elements()) {
        grab.error_m = 0.0;
    }
    for (std::size_t island = 0; island < io.frame.graph.islands.size(); ++island) {
        write_island_errors(io, island, stats);
    }
    for (const std::uint32_t i : io.frame.hidden_overlaps.deep) {
        stats.residual_m = std::max(stats.residual_m, io.frame.hidden_overlaps.of_body[i].depth_m);
    }
}

}  // namespace

void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning,
                      const HeadTuning& head, StageStats& stats) {
    restore_penetrating_bodies(io.collision, io.frame, tuning, stats);
    limit_pushes(io, head);
    write_poses(io);
    write_errors(io, stats);
    stats.contacts += io.frame.contacts.size();
    const CollisionWork work = io.collision.take_work();
    stats.narrowphase_calls += work.narrowphase_calls;
    stats.bounds_updates += work.bounds_updates;
    stats.tree_queries += work.tree_queries;
    stats.fallbacks[static_cast<std::size_t>(Fallback::pairs_deferred)] += work.deferred_pairs;
    stats.active_bodies += io.frame.active.list.size();
}

}  // namespace handhold
