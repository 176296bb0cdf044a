#include "systems/physics/finish_positions.hpp"

#include <algorithm>
#include <optional>

#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// --- What is sunk into surfaces
// ------------------------------------------------------------------------------------

// As far as an arm jumps: what has been dragged along sunk for longer stays where it is.
constexpr double k_max_restore_distance_m = 2.0;
constexpr double k_max_error_ratio = 0.5;  // of its error must be gone

// The worst error of a body's own rows, hands excepted; or of its contacts alone.
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

// What is fixed or driven that a body overlaps most, if anything.
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

// The same, or where no contact says so what it is sunk into unseen.
std::optional<std::uint32_t> overlapped_fixed_body(const FrameGraph& frame, std::uint32_t body) {
    const std::optional<std::uint32_t> wall = deepest_fixed_contact(frame.graph, body);
    const Overlap& hidden = frame.hidden_overlaps.of_body[body];
    const bool is_wall =
        hidden.depth_m > 0.0 && frame.graph.bodies[hidden.with].role == BodyRole::fixed;
    return wall || !is_wall ? wall : std::optional(hidden.with);
}

// The deepest overlap in an island.
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

// Lists free bodies that are sunk, as they are: by island, then those that no row holds, for
// themselves.
void find_penetrating_bodies(double restore_depth_m, FrameGraph& frame) {
    const ConstraintGraph& graph = frame.graph;
    frame.penetrating_bodies.clear();
    const auto islands = static_cast<std::uint32_t>(graph.islands.size());
    for (std::uint32_t i = 0; i < islands; ++i) {
        if (worst_overlap_m(frame, graph.islands[i]) >= restore_depth_m) {
            for (const std::uint32_t index : graph.bodies_of(graph.islands[i])) {
                add_if_penetrating(restore_depth_m, index, i, frame);
            }
        }
    }
    for (std::uint32_t index = 0; index < graph.bodies.size(); ++index) {
        const auto holds_it = [index](const RowBlock& block) {
            return block.a == index || block.b == index;
        };
        if (hidden_overlap_m(frame, index) >= restore_depth_m &&
            std::ranges::none_of(graph.blocks, holds_it)) {
            add_if_penetrating(restore_depth_m, index, islands + index, frame);
        }
    }
}

// To where it last overlapped nothing, carried along by the wall it is sunk into.
void restore_last_valid_pose(const FrameGraph::PenetratingBody& sunk, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[sunk.body];
    Pose valid_ws = frame.proxies[sunk.body].from_ws;
    if (const std::optional<std::uint32_t> found = overlapped_fixed_body(frame, sunk.body)) {
        const SolverBody& wall = frame.graph.bodies[*found];
        const ColliderProxy& proxy = frame.proxies[*found];
        valid_ws = proxy.to_ws * (inverse(proxy.from_ws) * valid_ws);
        body.velocity_mps =
            wall.velocity_mps + wall.spin_radps.cross(valid_ws.position - wall.pose_ws.position);
        body.spin_radps = wall.spin_radps;
    }
    body.pose_ws = valid_ws * Pose{-body.collider_offset_bs, Quat::Identity()};
}

void undo_restore(const FrameGraph::PenetratingBody& sunk, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[sunk.body];
    body.pose_ws = sunk.pose_ws;
    body.velocity_mps = sunk.velocity_mps;
    body.spin_radps = sunk.spin_radps;
}

// What was found inside of things says nothing about where they are now.
void rebuild_contacts(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats) {
    FrameGraph& frame = io.frame;
    const auto is_penetrating = [&frame](std::uint64_t id) {
        return std::ranges::any_of(frame.penetrating_bodies,
                                   [&](const FrameGraph::PenetratingBody& sunk) {
                                       return frame.graph.bodies[sunk.body].id == id;
                                   });
    };
    std::erase_if(frame.contacts, [&](const ContactPoint& contact) {
        return is_penetrating(contact.id_a) || is_penetrating(contact.id_b);
    });
    const FoundContacts found = refresh_contacts(
        {io.collision, frame.proxies, frame.contacts, frame.graph, frame.fresh_contacts},
        {tuning.margin_m, tuning.sweep_m}, OldPoints::replaced);
    if (found == FoundContacts::unchanged) {
        replace_contact_rows(frame.contacts, frame.graph);
    } else {
        ++stats.contact_rounds;
    }
}

// The sunk bodies of one island stay put back, which is counted, or are all sunk again. True where
// any are.
bool undo_failed_restores(FrameGraph& frame, StageStats& stats) {
    const auto is_better = [&frame](const FrameGraph::PenetratingBody& sunk) {
        const double moved_m =
            (frame.graph.bodies[sunk.body].pose_ws.position - sunk.pose_ws.position).norm();
        return moved_m < k_max_restore_distance_m &&
               own_error_m(frame.graph, sunk.body, false) < k_max_error_ratio * sunk.error_m;
    };
    const std::vector<FrameGraph::PenetratingBody>& sunk = frame.penetrating_bodies;
    bool undone = false;
    for (auto first = sunk.begin(); first != sunk.end();) {
        const auto last =
            std::find_if(first, sunk.end(), [&](const FrameGraph::PenetratingBody& other) {
                return other.island != first->island;
            });
        if (std::all_of(first, last, is_better)) {
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
    find_missed_overlaps(
        {io.collision, frame.proxies, frame.contacts, frame.graph, frame.fresh_contacts},
        {tuning.margin_m, tuning.sweep_m}, frame.hidden_overlaps);
    find_penetrating_bodies(tuning.restore_depth_m, frame);
    if (frame.penetrating_bodies.empty()) {
        return;
    }
    for (const FrameGraph::PenetratingBody& sunk : frame.penetrating_bodies) {
        restore_last_valid_pose(sunk, frame);
    }
    rebuild_contacts(io, tuning, stats);
    if (undo_failed_restores(frame, stats)) {
        rebuild_contacts(io, tuning, stats);
    }
}

// --- Results
// ------------------------------------------------------------------------------------

void write_poses(const FinishPositionsIo& io) {
    FrameGraph& frame = io.frame;
    for (std::uint32_t i = 0; i < frame.graph.bodies.size(); ++i) {
        const SolverBody& body = frame.graph.bodies[i];
        if (body.role == BodyRole::fixed) {
            continue;
        }
        const Entity entity = frame.entities[i];
        if (body.role == BodyRole::translating) {
            io.origin.at(entity).pose_ws.position = body.pose_ws.position;
            frame.phase[i].push_back_m =
                (body.pose_ws.position - frame.phase[i].reached_ws.position).norm();
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

void take_worst(const JointError& error, StageStats& stats) {
    stats.joint_error_m = std::max(stats.joint_error_m, error.point_m);
    stats.joint_error_rad = std::max(stats.joint_error_rad, error.angle_rad);
}

// What the island's last solve left of its joints, if it told and nothing was moved since.
std::optional<JointError> cached_joint_error(const FrameGraph& frame, std::size_t island) {
    const bool is_cached = frame.penetrating_bodies.empty() && frame.island_errors[island];
    return is_cached ? frame.island_errors[island]->joints : std::nullopt;
}

void write_island_errors(const FinishPositionsIo& io, std::size_t island, StageStats& stats) {
    const ConstraintGraph& graph = io.frame.graph;
    const std::optional<JointError> cached = cached_joint_error(io.frame, island);
    take_worst(cached.value_or(JointError{}), stats);
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
            take_worst(joint_error(graph.bodies, block), stats);
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
    for (const Overlap& hidden : io.frame.hidden_overlaps.of_body) {
        stats.residual_m = std::max(stats.residual_m, hidden.depth_m);
    }
}

}  // namespace

void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats) {
    restore_penetrating_bodies(io, tuning, stats);
    write_poses(io);
    write_errors(io, stats);
    stats.contacts += io.frame.contacts.size();
}

}  // namespace handhold
