// Physics: bodies that the phases left penetrating.
#include "systems/physics/shared/restore_bodies.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// Bodies of heaps with more constraint blocks are not restored, because of the cost per frame.
// Heaps in a player's island have a higher limit, because players see their overlaps.
constexpr std::size_t k_max_pushed_restore_blocks = 4000;
constexpr std::size_t k_max_loose_restore_blocks = 300;
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

// The largest error of a body's rows without grips, and of its hidden overlaps.
double error_m(const FrameGraph& frame, std::uint32_t body) {
    return std::max(own_error_m(frame.graph, body, false), hidden_overlap_m(frame, body));
}

// The fixed or kinematic body that `body` penetrates most by its contacts; if no contact shows one,
// the fixed body of a hidden overlap.
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

// The body as the phases left it, with its last valid pose as `carrier` carries it along.
FrameGraph::PenetratingBody penetrating_body(const FrameGraph& frame, std::uint32_t index,
                                             std::uint32_t island, std::uint32_t carrier) {
    const SolverBody& body = frame.graph.bodies[index];
    Pose valid_ws = frame.proxies[index].from_ws;  // last valid pose of the collider
    if (carrier != index) {
        const ColliderProxy& proxy = frame.proxies[carrier];
        valid_ws = proxy.to_ws * (inverse(proxy.from_ws) * valid_ws);
    }
    if (body.role == BodyRole::translating) {
        valid_ws = {valid_ws.position - body.pose_ws.rotation * body.collider_offset_bs,
                    body.pose_ws.rotation};
    } else {
        valid_ws = valid_ws * Pose{-body.collider_offset_bs, Quat::Identity()};
    }
    return {.body = index,
            .island = island,
            .error_m = error_m(frame, index),
            .carrier = carrier,
            .valid_ws = valid_ws,
            .pose_ws = body.pose_ws,
            .velocity_mps = body.velocity_mps,
            .spin_radps = body.spin_radps};
}

void add_if_penetrating(double restore_depth_m, std::uint32_t index, std::uint32_t island,
                        FrameGraph& frame) {
    const double hidden_m = hidden_overlap_m(frame, index);
    if (frame.graph.bodies[index].role == BodyRole::free &&
        std::max(own_error_m(frame.graph, index, true), hidden_m) >= restore_depth_m) {
        const std::uint32_t carrier = overlapped_fixed_body(frame, index).value_or(index);
        frame.penetrating_bodies.push_back(penetrating_body(frame, index, island, carrier));
    }
}

bool is_too_large(const ConstraintGraph& graph, const Island& island) {
    const bool has_player = std::ranges::any_of(graph.bodies_of(island), [&](std::uint32_t i) {
        return graph.bodies[i].role == BodyRole::translating;
    });
    return island.is_heap &&
           graph.blocks_of(island).size() >
               (has_player ? k_max_pushed_restore_blocks : k_max_loose_restore_blocks);
}

// Lists the penetrating free bodies, grouped by island.
void find_penetrating_bodies(double restore_depth_m, FrameGraph& frame, StageStats& stats) {
    const ConstraintGraph& graph = frame.graph;
    frame.penetrating_bodies.clear();
    const auto islands = static_cast<std::uint32_t>(graph.islands.size());
    for (std::uint32_t i = 0; i < islands; ++i) {
        const Island& island = graph.islands[i];
        if (worst_overlap_m(frame, island) < restore_depth_m) {
            continue;
        }
        if (is_too_large(graph, island)) {
            stats.count(Fallback::solver_budget);
        } else {
            for (const std::uint32_t index : graph.bodies_of(graph.islands[i])) {
                add_if_penetrating(restore_depth_m, index, i, frame);
            }
        }
    }
}

// Moves a body or player to its last valid pose. Beside a fixed or kinematic body it gets that
// body's velocity.
void restore(const FrameGraph::PenetratingBody& penetrating, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[penetrating.body];
    body.pose_ws = penetrating.valid_ws;
    const SolverBody& carrier = frame.graph.bodies[penetrating.carrier];
    if (carrier.role == BodyRole::fixed) {
        const Vec3 arm_m = body.pose_ws.position - carrier.pose_ws.position;
        body.velocity_mps = carrier.velocity_mps + carrier.spin_radps.cross(arm_m);
        body.spin_radps = carrier.spin_radps;
    }
}

void undo_restore(const FrameGraph::PenetratingBody& penetrating, FrameGraph& frame) {
    SolverBody& body = frame.graph.bodies[penetrating.body];
    body.pose_ws = penetrating.pose_ws;
    body.velocity_mps = penetrating.velocity_mps;
    body.spin_radps = penetrating.spin_radps;
}

// Drops the contacts found at the penetrating poses and searches contacts and hidden overlaps again
// at the present poses.
void rebuild_contacts(CollisionWorld& collision, FrameGraph& frame, const ContactTuning& tuning,
                      StageStats& stats) {
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
    refresh_contacts({collision, frame.proxies, frame.contacts, frame.graph, frame.fresh_contacts,
                      frame.proxy_updates, frame.active.list},
                     {tuning.margin_m, tuning.sweep_m}, OldPoints::replaced);
    ++stats.contact_rounds;
    activate_islands(frame);
    find_missed_overlaps(collision, frame.proxies, frame.graph, tuning.sweep_m,
                         frame.hidden_overlaps);
}

bool is_improved(const FrameGraph& frame, const FrameGraph::PenetratingBody& penetrating) {
    const double way_m = (penetrating.valid_ws.position - penetrating.pose_ws.position).norm();
    return way_m < k_max_restore_distance_m &&
           error_m(frame, penetrating.body) < k_max_error_ratio * penetrating.error_m;
}

// Keeps the restores of an island if they improve each of its listed bodies. Bodies whose restores
// were kept before are not evaluated again.
void keep_helpful_restores(FrameGraph& frame) {
    std::span<FrameGraph::PenetratingBody> rest = frame.penetrating_bodies;
    while (!rest.empty()) {
        const std::uint32_t island = rest.front().island;
        const auto end = std::ranges::find_if(
            rest, [&](const FrameGraph::PenetratingBody& body) { return body.island != island; });
        const auto group = rest.first(static_cast<std::size_t>(end - rest.begin()));
        const bool help = std::ranges::all_of(group, [&](const FrameGraph::PenetratingBody& body) {
            return body.is_restored || is_improved(frame, body);
        });
        for (FrameGraph::PenetratingBody& body : group) {
            body.is_restored = body.is_restored || help;
        }
        rest = rest.subspan(group.size());
    }
}

// Adds free bodies and players that a listed body overlaps by k_joining_depth_m or more to the end
// of the list: they may have moved to where it was. A body that several listed bodies overlap gets
// the island of one whose restore is kept, if there is one.
void add_overlapped_bodies(FrameGraph& frame) {
    std::vector<FrameGraph::PenetratingBody>& listed = frame.penetrating_bodies;
    const std::size_t count = listed.size();
    const auto find = [&](std::uint32_t body, std::size_t among) {
        const auto bodies = std::span(listed).first(among);
        const auto found = std::ranges::find(bodies, body, &FrameGraph::PenetratingBody::body);
        return found == bodies.end() ? nullptr : &*found;
    };
    const auto add = [&](std::uint32_t index, std::uint32_t other, bool is_restored) {
        const BodyRole role = frame.graph.bodies[index].role;
        const bool may_move = role == BodyRole::free || role == BodyRole::translating;
        const FrameGraph::PenetratingBody* const carrier = find(other, count);
        if (!may_move || carrier == nullptr || carrier->is_restored != is_restored ||
            find(index, listed.size()) != nullptr) {
            return;
        }
        const std::uint32_t island = carrier->island;
        listed.push_back(penetrating_body(frame, index, island, other));
    };
    for (const bool is_restored : {true, false}) {
        for (const RowBlock& block : frame.graph.blocks) {
            // Overlaps within heaps, and heaps whose restores were not kept, are left to the next
            // frames.
            const bool in_heap =
                frame.graph.bodies[block.a].in_heap || frame.graph.bodies[block.b].in_heap;
            if (is_contact(block) && !is_heap_contact(frame.graph.bodies, block) &&
                (is_restored || !in_heap) &&
                block_error_m(frame.graph.bodies, block) >= k_joining_depth_m) {
                add(block.a, block.b, is_restored);
                add(block.b, block.a, is_restored);
            }
        }
    }
}

// Restores the bodies that listed bodies overlap, and adds them to the list. Undoes restores that
// were not kept in islands to which no body was added. False if no body was added.
bool restore_overlapped_bodies(FrameGraph& frame) {
    std::vector<FrameGraph::PenetratingBody>& listed = frame.penetrating_bodies;
    const std::size_t count = listed.size();
    add_overlapped_bodies(frame);
    if (listed.size() == count) {
        return false;
    }
    const auto added = std::span(listed).subspan(count);
    for (const FrameGraph::PenetratingBody& penetrating : added) {
        restore(penetrating, frame);
    }
    for (const FrameGraph::PenetratingBody& penetrating : std::span(listed).first(count)) {
        const bool gets_another = std::ranges::any_of(
            added, [&](const auto& other) { return other.island == penetrating.island; });
        if (!penetrating.is_restored && !gets_another) {
            undo_restore(penetrating, frame);
        }
    }
    // Sorts kept restores first, so that the first body of an island tells whether any of its
    // restores was kept.
    std::ranges::sort(listed, {}, [](const FrameGraph::PenetratingBody& penetrating) {
        return std::tuple(penetrating.island, !penetrating.is_restored, penetrating.body);
    });
    return true;
}

// Puts the bodies whose restores were not kept back to where the phases left them. False if there
// are none.
bool undo_other_restores(FrameGraph& frame) {
    bool undone = false;
    for (const FrameGraph::PenetratingBody& body : frame.penetrating_bodies) {
        if (!body.is_restored) {
            undo_restore(body, frame);
            undone = true;
        }
    }
    return undone;
}

void count_restored_islands(const FrameGraph& frame, StageStats& stats) {
    const std::vector<FrameGraph::PenetratingBody>& listed = frame.penetrating_bodies;
    for (std::size_t i = 0; i < listed.size(); ++i) {
        const bool is_first = i == 0 || listed[i - 1].island != listed[i].island;
        if (is_first && listed[i].is_restored) {
            stats.count(Fallback::restored_last_valid_pose);
        }
    }
}

}  // namespace

void restore_penetrating_bodies(CollisionWorld& collision, FrameGraph& frame,
                                const ContactTuning& tuning, StageStats& stats) {
    find_missed_overlaps(collision, frame.proxies, frame.graph, tuning.sweep_m,
                         frame.hidden_overlaps);
    find_penetrating_bodies(tuning.restore_depth_m, frame, stats);
    if (frame.penetrating_bodies.empty()) {
        return;
    }
    for (const FrameGraph::PenetratingBody& penetrating : frame.penetrating_bodies) {
        restore(penetrating, frame);
    }
    rebuild_contacts(collision, frame, tuning, stats);
    keep_helpful_restores(frame);
    if (restore_overlapped_bodies(frame)) {
        rebuild_contacts(collision, frame, tuning, stats);
        keep_helpful_restores(frame);
    }
    if (undo_other_restores(frame)) {
        rebuild_contacts(collision, frame, tuning, stats);
    }
    count_restored_islands(frame, stats);
}

}  // namespace handhold
