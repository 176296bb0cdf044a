#include "systems/physics/finish_positions.hpp"

#include <algorithm>

#include "engine/solver/moving_contacts.hpp"

namespace handhold {
namespace {

// --- What is sunk into surfaces
// ------------------------------------------------------------------------------------

// What a body overlaps most, of all that does not give way; null where there is nothing.
const std::uint32_t* deepest_wall(const ConstraintGraph& graph, const Island& island,
                                  std::uint32_t body) {
    const std::uint32_t* wall = nullptr;
    double depth_m = 0.0;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        const RowBlock& block = graph.blocks[i];
        if (!is_contact(block) || (block.a != body && block.b != body)) {
            continue;
        }
        const std::uint32_t& other = block.a == body ? block.b : block.a;
        const double overlap_m = block_error_m(graph.bodies, block);
        if (graph.bodies[other].role == BodyRole::fixed && overlap_m > depth_m) {
            depth_m = overlap_m;
            wall = &other;
        }
    }
    return wall;
}

// Lists the free bodies of islands that are sunk, as they are.
void note_sunk_bodies(double sunk_m, FrameGraph& frame) {
    frame.sunk_bodies.clear();
    for (const Island& island : frame.graph.islands) {
        const double error_m = island_errors(frame.graph, island).without_hands_m();
        if (error_m < sunk_m) {
            continue;
        }
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            const SolverBody& body = frame.graph.bodies[i];
            if (body.role == BodyRole::free) {
                frame.sunk_bodies.push_back(
                    {i, error_m, body.pose_ws, body.velocity_mps, body.spin_radps});
            }
        }
    }
    std::ranges::sort(frame.sunk_bodies, {}, &FrameGraph::SunkBody::body);
}

const FrameGraph::SunkBody* find_sunk(const FrameGraph& frame, std::uint32_t body) {
    const auto found =
        std::ranges::lower_bound(frame.sunk_bodies, body, {}, &FrameGraph::SunkBody::body);
    return found != frame.sunk_bodies.end() && found->body == body ? &*found : nullptr;
}

void step_back(const Island& island, std::uint32_t index, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[index];
    Pose valid_ws = frame.proxies[index].from_ws;
    if (const std::uint32_t* const found = deepest_wall(frame.graph, island, index)) {
        const SolverBody& wall = frame.graph.bodies[*found];
        const ColliderProxy& proxy = frame.proxies[*found];
        valid_ws = proxy.to_ws * (inverse(proxy.from_ws) * valid_ws);
        body.velocity_mps =
            wall.velocity_mps + wall.spin_radps.cross(valid_ws.position - wall.pose_ws.position);
        body.spin_radps = wall.spin_radps;
    }
    body.pose_ws = valid_ws * Pose{-body.collider_offset_bs, Quat::Identity()};
}

// What was found inside of things says nothing about where they are now.
void find_contacts_anew(const FinishPositionsIo& io, const ContactTuning& tuning,
                        StageStats& stats) {
    FrameGraph& frame = io.frame;
    const auto is_sunk = [&frame](std::uint64_t id) {
        const auto body = static_cast<std::uint32_t>(find_body(frame.graph, id));
        return find_sunk(frame, body) != nullptr;
    };
    std::erase_if(frame.contacts, [&](const ContactPoint& contact) {
        return is_sunk(contact.id_a) || is_sunk(contact.id_b);
    });
    refresh_contacts(
        {io.collision, frame.proxies, frame.contacts, frame.graph, frame.fresh_contacts},
        {tuning.margin_m, tuning.sweep_m}, OldPoints::replaced);
    ++stats.contact_rounds;
}

// True where an island was better off sunk, and is as it was.
bool undo_where_worse(FrameGraph& frame, StageStats& stats) {
    bool undone = false;
    for (const Island& island : frame.graph.islands) {
        double sunk_m = 0.0;
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            const FrameGraph::SunkBody* const sunk = find_sunk(frame, i);
            sunk_m = std::max(sunk_m, sunk != nullptr ? sunk->error_m : 0.0);
        }
        if (sunk_m == 0.0) {
            continue;
        }
        if (island_errors(frame.graph, island).without_hands_m() < sunk_m) {
            stats.count(Fallback::put_back);
            continue;
        }
        undone = true;
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            if (const FrameGraph::SunkBody* const sunk = find_sunk(frame, i)) {
                SolverBody& body = frame.graph.bodies[i];
                body.pose_ws = sunk->pose_ws;
                body.velocity_mps = sunk->velocity_mps;
                body.spin_radps = sunk->spin_radps;
            }
        }
    }
    return undone;
}

void put_back(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats) {
    FrameGraph& frame = io.frame;
    note_sunk_bodies(tuning.sunk_m, frame);
    if (frame.sunk_bodies.empty()) {
        return;
    }
    for (const Island& island : frame.graph.islands) {
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            if (find_sunk(frame, i) != nullptr) {
                step_back(island, i, frame);
            }
        }
    }
    find_contacts_anew(io, tuning, stats);
    if (undo_where_worse(frame, stats)) {
        find_contacts_anew(io, tuning, stats);
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
        if (body.role == BodyRole::player) {
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
    point.kind = RowKind::hand_point;
    const double error = block_error_m(io.frame.graph.bodies, point);
    stats.hand_error_m = std::max(stats.hand_error_m, error);
    io.grab.rows()[block.source].error_m = error;
}

void write_errors(const FinishPositionsIo& io, StageStats& stats) {
    for (Grab& grab : io.grab.rows()) {
        grab.error_m = 0.0;
    }
    const ConstraintGraph& graph = io.frame.graph;
    for (const RowBlock& block : graph.blocks) {
        if (is_hand(block)) {
            write_hand_error(io, block, stats);
        } else if (is_joint(block)) {
            const JointError error = joint_error(graph.bodies, block);
            stats.joint_error_m = std::max(stats.joint_error_m, error.point_m);
            stats.joint_error_rad = std::max(stats.joint_error_rad, error.angle_rad);
        } else {
            const double overlap = block_error_m(graph.bodies, block);
            stats.residual_m = std::max(stats.residual_m, overlap);
            if (overlap > k_new_overlap_m) {
                stats.count(Fallback::contacts_unresolved);
            }
        }
    }
}

}  // namespace

void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats) {
    put_back(io, tuning, stats);
    write_poses(io);
    write_errors(io, stats);
    stats.contacts += io.frame.contacts.size();
}

}  // namespace handhold
