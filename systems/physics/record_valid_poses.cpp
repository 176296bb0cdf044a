#include "systems/physics/record_valid_poses.hpp"

#include <algorithm>

#include "engine/solver/model/collider_pose.hpp"

namespace handhold {
namespace {

// For each body, the other body of its deepest overlap; its own index if no overlap is too deep.
void find_overlaps(FrameGraph& frame) {
    const ConstraintGraph& graph = frame.graph;
    // Entries of inactive bodies keep old values, which are not read.
    frame.overlap_m.resize(graph.bodies.size());
    frame.overlaps_with.resize(graph.bodies.size());
    const auto clear = [&frame](std::uint32_t body) {
        frame.overlap_m[body] = k_valid_overlap_m;
        frame.overlaps_with[body] = body;
    };
    std::ranges::for_each(frame.active.list, clear);
    for (const RowBlock& block : graph.blocks) {
        clear(block.a);
        clear(block.b);
    }
    const auto update = [&frame](std::uint32_t body, std::uint32_t other, double depth_m) {
        if (depth_m > frame.overlap_m[body]) {
            frame.overlap_m[body] = depth_m;
            frame.overlaps_with[body] = other;
        }
    };
    for (const RowBlock& block : graph.blocks) {
        if (is_contact(block)) {
            const double depth_m = block_error_m(graph.bodies, block);
            update(block.a, block.b, depth_m);
            update(block.b, block.a, depth_m);
        }
    }
    for (const std::uint32_t i : frame.hidden_overlaps.deep) {
        const Overlap& hidden = frame.hidden_overlaps.of_body[i];
        update(i, hidden.with, hidden.depth_m);
    }
}

}  // namespace

void record_valid_poses(const RecordValidPosesIo& io) {
    FrameGraph& frame = io.frame;
    find_overlaps(frame);
    for (const std::uint32_t i : frame.active.list) {
        LastValidPose* const valid = io.last_valid.find(frame.entities[i]);
        if (valid == nullptr) {
            continue;
        }
        const SolverBody& body = frame.graph.bodies[i];
        const HeadTracking* const head =
            body.role == BodyRole::translating ? io.head.find(frame.entities[i]) : nullptr;
        valid->known = head == nullptr || head->state != TrackingState::never;
        if (frame.overlaps_with[i] == i) {
            valid->pose_ws = collider_pose(body);
            continue;
        }
        frame.active.note(i);  // the sweep of the next frame starts elsewhere
        // The body penetrates: keeps its last valid pose, carried along if the obstacle moves.
        const ColliderProxy& other = frame.proxies[frame.overlaps_with[i]];
        if (frame.graph.bodies[frame.overlaps_with[i]].role == BodyRole::fixed) {
            valid->pose_ws = other.to_ws * (inverse(other.from_ws) * valid->pose_ws);
        }
    }
}

}  // namespace handhold
