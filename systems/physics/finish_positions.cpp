#include "systems/physics/finish_positions.hpp"

#include <algorithm>
#include <optional>

#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// --- Restoring penetrating bodies ----------------------------------------------------------------

// Bodies of heaps with more constraint blocks are not restored, because of the cost per frame.
constexpr std::size_t k_max_restore_blocks = 4000;
// About the length of an arm's jump. A body that was dragged farther while penetrating stays.
constexpr double k_max_restore_distance_m = 2.0;
constexpr double k_max_error_ratio = 0.5;  // a restore must reduce the error at least to this share

// The worst error of a body's own rows without grips, or of its contacts only.
double own_error_m(const ConstraintGraph& graph, std::uint32_t body, bool only_contacts) {
    double worst = 0.0;
    for (const RowBlock& block : graph.blocks) {
        const bool counts = only_contacts ? is_contact(block) : !is_drive(block);
        if (counts && (block.a == body || block.b == body)) {
            worst = std::max(worst, block_error_m(graph.bodies, block));
        }
    }
    return worst;
}

// The fixed or kinematic body that `body` penetrates most by its contacts; nullopt if none.
std::optional<std::uint32_t> deepest_fixed_contact(const ConstraintGraph& graph,
                                                   std::uint32_t body) {
    std::optional<std::uint32_t> wall;
    double depth_m = 0.0;
    for (const RowBlock& block : graph.blocks) {
        if (!is_contact(block) || (block.a != body && block.b != body)) {
            continue;
        }
        const std::uint32_t other = block.a == body ? block.b : block.a;
        const double overlap_m = block_error_m(graph.bodies, block);
        if (graph.bodies[other].role == BodyRole::fixed && overlap_m > depth_m) {
            depth_m = overlap_m;
            wall = other;
        }
    }
    return wall;
}

double hidden_overlap_m(const FrameGraph& frame, std::uint32_t body) {
    return frame.hidden_overlaps.of_body[body].depth_m;
}

// The same; if no contact shows one, the body of a hidden overlap.
std::optional<std::uint32_t> overlapped_fixed_body(const FrameGraph& frame, std::uint32_t body) {
    const std::optional<std::uint32_t> wall = deepest_fixed_contact(frame.graph, body);
    const Overlap& hidden = frame.hidden_overlaps.of_body[body];
    const bool is_wall =
        hidden.depth_m > 0.0 && frame.graph.bodies[hidden.with].role == BodyRole::fixed;
    return wall || !is_wall ? wall : std::optional(hidden.with);
}

// The deepest overlap in an island, hidden overlaps included.
double worst_overlap_m(const FrameGraph& frame, const Island& island) {
    const ConstraintGraph& graph = frame.graph;
    double worst = 0.0;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        if (is_contact(graph.blocks[i])) {
            worst = std::max(worst, block_error_m(graph.bodies, graph.blocks[i]));
        }
    }
    for (const std::uint32_t i : graph.bodies_of(island)) {
        worst = std::max(worst, hidden_overlap_m(frame, i));
    }
    return worst;
}

void add_if_penetrating(double restore_depth_m, std::uint32_t index, std::uint32_t island,
                        FrameGraph& frame) {
    const SolverBody& body = frame.graph.bodies[index];
    const double hidden_m = hidden_overlap_m(frame, index);
    if (body.role == BodyRole::free &&
        std::max(own_error_m(frame.graph, index, true), hidden_m) >= restore_depth_m) {
        const double error_m = std::max(own_error_m(frame.graph, index, false), hidden_m);
        frame.penetrating_bodies.push_back(
            {index, island, error_m, body.pose_ws, body.velocity_mps, body.spin_radps});
    }
}

// Lists the penetrating free bodies, grouped by island; a body without rows makes a group of its
// own.
void find_penetrating_bodies(double restore_depth_m, FrameGraph& frame, StageStats& stats) {
    const ConstraintGraph& graph = frame.graph;
    frame.penetrating_bodies.clear();
    const auto islands = static_cast<std::uint32_t>(graph.islands.size());
    for (std::uint32_t i = 0; i < islands; ++i) {
        const Island& island = graph.islands[i];
        if (worst_overlap_m(frame, island) < restore_depth_m) {
            continue;
        }
        if (island.is_heap && graph.blocks_of(island).size() > k_max_restore_blocks) {
            stats.count(Fallback::solver_budget);
        } else {
            for (const std::uint32_t index : graph.bodies_of(graph.islands[i])) {
                add_if_penetrating(restore_depth_m, index, i, frame);
            }
        }
    }
    for (const std::uint32_t index : frame.hidden_overlaps.deep) {
        const auto involves_body = [index](const RowBlock& block) {
            return block.a == index || block.b == index;
        };
        if (hidden_overlap_m(frame, index) >= restore_depth_m &&
            std::ranges::none_of(graph.blocks, involves_body)) {
            add_if_penetrating(restore_depth_m, index, islands + index, frame);
        }
    }
}

// Moves a body to its last valid pose, carried along by the fixed or kinematic body it penetrates.
void restore_last_valid_pose(const FrameGraph::PenetratingBody& penetrating, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[penetrating.body];
    Pose valid_ws = frame.proxies[penetrating.body].from_ws;
    if (const std::optional<std::uint32_t> found = overlapped_fixed_body(frame, penetrating.body)) {
        const SolverBody& wall = frame.graph.bodies[*found];
        const ColliderProxy& proxy = frame.proxies[*found];
        valid_ws = proxy.to_ws * (inverse(proxy.from_ws) * valid_ws);
        body.velocity_mps =
            wall.velocity_mps + wall.spin_radps.cross(valid_ws.position - wall.pose_ws.position);
        body.spin_radps = wall.spin_radps;
    }
    body.pose_ws = valid_ws * Pose{-body.collider_offset_bs, Quat::Identity()};
}

void undo_restore(const FrameGraph::PenetratingBody& penetrating, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[penetrating.body];
    body.pose_ws = penetrating.pose_ws;
    body.velocity_mps = penetrating.velocity_mps;
    body.spin_radps = penetrating.spin_radps;
}

// Contacts found at the penetrating poses are dropped; those at the restored poses are found again.
void rebuild_contacts(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats) {
    FrameGraph& frame = io.frame;
    const auto is_penetrating = [&frame](std::uint64_t id) {
        return std::ranges::any_of(frame.penetrating_bodies,
                                   [&](const FrameGraph::PenetratingBody& penetrating) {
                                       return frame.graph.bodies[penetrating.body].id == id;
                                   });
    };
    std::erase_if(frame.contacts, [&](const ContactPoint& contact) {
        return is_penetrating(contact.id_a) || is_penetrating(contact.id_b);
    });
    // Colliders of bodies whose is_searched is false would not move to the restored poses. Their
    // contacts there would be missing, and every restored pose would seem valid.
    for (const FrameGraph::PenetratingBody& penetrating : frame.penetrating_bodies) {
        frame.graph.bodies[penetrating.body].is_searched = true;
    }
    refresh_contacts(
        {io.collision, frame.proxies, frame.contacts, frame.graph, frame.fresh_contacts,
         frame.proxy_updates, frame.displaced, frame.active.list},
        {tuning.margin_m, tuning.sweep_m}, OldPoints::replaced);
    ++stats.contact_rounds;
    activate_islands(frame);
}

// For each island: keeps the restores of all its bodies (counted), or undoes them all. True if any
// were undone.
bool undo_failed_restores(FrameGraph& frame, StageStats& stats) {
    const auto is_improved = [&frame](const FrameGraph::PenetratingBody& penetrating) {
        const double moved_m =
            (frame.graph.bodies[penetrating.body].pose_ws.position - penetrating.pose_ws.position)
                .norm();
        return moved_m < k_max_restore_distance_m &&
               own_error_m(frame.graph, penetrating.body, false) <
                   k_max_error_ratio * penetrating.error_m;
    };
    const std::vector<FrameGraph::PenetratingBody>& penetrating = frame.penetrating_bodies;
    bool undone = false;
    for (auto first = penetrating.begin(); first != penetrating.end();) {
        const auto last =
            std::find_if(first, penetrating.end(), [&](const FrameGraph::PenetratingBody& other) {
                return other.island != first->island;
            });
        if (std::all_of(first, last, is_improved)) {
            stats.count(Fallback::restored_last_valid_pose);
            std::for_each(first, last, [&](const FrameGraph::PenetratingBody& body) {
                frame.hidden_overlaps.of_body[body.body] = {0.0, body.body};
            });
        } else {
            std::for_each(first, last, [&](const FrameGraph::PenetratingBody& body) {
                undo_restore(body, frame);
            });
            undone = true;
        }
        first = last;
    }
    return undone;
}

void restore_penetrating_bodies(const FinishPositionsIo& io, const ContactTuning& tuning,
                                StageStats& stats) {
    FrameGraph& frame = io.frame;
    find_missed_overlaps({io.collision, frame.proxies, frame.contacts, frame.graph,
                          frame.fresh_contacts, frame.proxy_updates, frame.displaced},
                         {tuning.margin_m, tuning.sweep_m}, frame.active.list,
                         frame.hidden_overlaps);
    for (const std::uint32_t i : frame.displaced) {
        frame.active.add(i);
    }
    find_penetrating_bodies(tuning.restore_depth_m, frame, stats);
    if (frame.penetrating_bodies.empty()) {
        return;
    }
    for (const FrameGraph::PenetratingBody& penetrating : frame.penetrating_bodies) {
        restore_last_valid_pose(penetrating, frame);
    }
    rebuild_contacts(io, tuning, stats);
    if (undo_failed_restores(frame, stats)) {
        rebuild_contacts(io, tuning, stats);
    }
}

// --- Players who are pushed out ------------------------------------------------------------------

// Largest speed at which a player who is stuck in a wall is pushed out of it.
constexpr double k_eject_mps = 3.0;

// Displacement of the head in this frame if no contact stops it, in world axes: the sum of grips,
// play space and tracking.
Vec3 head_motion_m(const FinishPositionsIo& io, std::uint32_t player, const HeadTuning& tuning) {
    const Entity entity = io.frame.entities[player];
    const HeadTracking& head = io.head.at(entity);
    const Pose& predicted_ws = io.origin.at(entity).pose_ws;
    const Vec3 tracked_ps = transform_point(head.pose_ps, tuning.center_m) -
                            transform_point(head.start_ps, tuning.center_m);
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
// penetration is reduced at k_eject_mps at most.
StuckIn stuck_in(const FinishPositionsIo& io, const RowBlock& block, const Vec3& motion_m) {
    const FrameGraph& frame = io.frame;
    const Pose& wall_ws = frame.graph.bodies[block.b].pose_ws;
    const ColliderProxy& wall = frame.proxies[block.b];
    const Vec3 normal = wall_ws.rotation * block.normal_b_bs;
    const Vec3 wall_motion_m = transform_point(wall.to_ws, block.point_b_bs) -
                               transform_point(wall.from_ws, block.point_b_bs);
    const double allowed_m =
        std::max(0.0, normal.dot(wall_motion_m - motion_m)) + k_eject_mps * io.dt_s;
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
        if (push_m.norm() <= k_eject_mps * io.dt_s) {
            continue;
        }
        const Vec3 motion_m = head_motion_m(io, i, tuning);
        StuckIn worst;
        for (const RowBlock& block : frame.graph.blocks) {
            if (is_contact(block) && block.a == i &&
                frame.graph.bodies[block.b].role == BodyRole::fixed) {
                const StuckIn found = stuck_in(io, block, motion_m);
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
    io.grab.rows()[block.source].error_m = error;
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
    for (Grab& grab : io.grab.rows()) {
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
    restore_penetrating_bodies(io, tuning, stats);
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
