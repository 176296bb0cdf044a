// Solver, sparse: symbolic factorisation. The data structures are described in the header.
// Sources: minimum degree as in George and Liu, The Evolution of the Minimum Degree Ordering
// Algorithm (1989), on blocks; bodies as unknowns after Baraff, Linear-Time Dynamics using Lagrange
// Multipliers (1996).
#include "engine/solver/sparse/elimination_plan.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// A body with more constraint rows than this is a hub, however few row nodes it has.
constexpr std::uint32_t k_hub_rows = 16;

}  // namespace

bool EliminationPlan::fits(std::span<const RowNode> nodes,
                           std::span<const std::uint8_t> can_rotate) const {
    return std::ranges::equal(nodes, nodes_) && std::ranges::equal(can_rotate, can_rotate_);
}

void EliminationPlan::build(std::span<const RowNode> nodes,
                            std::span<const std::uint8_t> can_rotate) {
    nodes_.assign(nodes.begin(), nodes.end());
    can_rotate_.assign(can_rotate.begin(), can_rotate.end());
    find_incidence();
    find_neighbours();
    order_nodes();
    find_updates();
    find_couplings();
    find_appearances();
}

void EliminationPlan::reserve(const EliminationPlan& other) {
    if (neighbours_.size() < other.neighbours_.size()) {
        neighbours_.resize(other.neighbours_.size());
    }
    for (std::size_t node = 0; node < other.neighbours_.size(); ++node) {
        neighbours_[node].reserve(other.neighbours_[node].capacity());
    }
    reserve_as(buffers(other), buffers(*this));
}

// Finds the row nodes of each body, and which bodies are hubs.
void EliminationPlan::find_incidence() {
    ends_begin_.assign(can_rotate_.size() + 1, 0);
    rows_of_slot_.assign(can_rotate_.size(), 0);
    for (const RowNode& node : nodes_) {
        for (const std::uint32_t slot : node.slots) {
            if (slot != k_no_slot) {
                rows_of_slot_[slot] += node.width;
                ++ends_begin_[slot + 1];
            }
        }
    }
    hubs_.clear();
    hub_of_slot_.assign(can_rotate_.size(), k_no_slot);
    for (std::uint32_t slot = 0; slot < can_rotate_.size(); ++slot) {
        if (ends_begin_[slot + 1] > k_hub_nodes || rows_of_slot_[slot] > k_hub_rows) {
            hub_of_slot_[slot] = static_cast<std::uint32_t>(hubs_.size());
            hubs_.push_back({slot, 0, 0});
        }
        ends_begin_[slot + 1] += ends_begin_[slot];
    }
    ends_.resize(ends_begin_.back());
    std::vector<std::uint32_t>& next = merged_;
    next.assign(ends_begin_.begin(), ends_begin_.end() - 1);
    for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t slot = nodes_[node].slots[side];
            if (slot != k_no_slot) {
                ends_[next[slot]++] = 2 * node + side;
            }
        }
    }
}

void EliminationPlan::connect(std::uint32_t x, std::uint32_t y) {
    if (x != y) {
        neighbours_[x].push_back(y);
        neighbours_[y].push_back(x);
    }
}

void EliminationPlan::find_neighbours() {
    const std::size_t count = nodes_.size() + hubs_.size();
    if (neighbours_.size() < count) {
        neighbours_.resize(count);
    }
    for (std::size_t node = 0; node < count; ++node) {
        neighbours_[node].clear();
    }
    for (std::uint32_t slot = 0; slot < can_rotate_.size(); ++slot) {
        for (std::uint32_t i = ends_begin_[slot]; i < ends_begin_[slot + 1]; ++i) {
            if (hub_of_slot_[slot] != k_no_slot) {
                const auto hub = static_cast<std::uint32_t>(nodes_.size()) + hub_of_slot_[slot];
                connect(ends_[i] / 2, hub);
                continue;
            }
            for (std::uint32_t j = ends_begin_[slot]; j < i; ++j) {
                connect(ends_[i] / 2, ends_[j] / 2);
            }
        }
    }
    for (std::size_t node = 0; node < count; ++node) {
        std::vector<std::uint32_t>& of = neighbours_[node];
        std::ranges::sort(of);
        of.erase(std::unique(of.begin(), of.end()), of.end());
    }
}

std::uint32_t EliminationPlan::weight_of(std::uint32_t node) const {
    std::uint32_t weight = 0;
    for (const std::uint32_t other : neighbours_[node]) {
        weight += width_of(other);
    }
    return weight;
}

// False for a row node that must wait for a hub: one of its bodies is a hub that is not eliminated
// yet, and no other body of the node can rotate. The node's diagonal is nearly 0 until that hub is
// eliminated. If the node came first, the hub's unknowns would be differences of numbers 1e10 times
// larger.
bool EliminationPlan::can_eliminate(std::uint32_t node) const {
    if (node >= nodes_.size() || nodes_[node].is_regularised) {
        return true;
    }
    bool needs_hub = false;
    for (const std::uint32_t slot : nodes_[node].slots) {
        if (slot == k_no_slot) {
            continue;
        }
        const std::uint32_t hub = hub_of_slot_[slot];
        if (hub != k_no_slot && eliminated_[nodes_.size() + hub] == 0) {
            needs_hub = true;
        } else if (can_rotate_[slot] != 0) {
            return true;
        }
    }
    return !needs_hub;
}

void EliminationPlan::order_nodes() {
    const std::size_t count = nodes_.size() + hubs_.size();
    // Among equal weights, the oldest candidate comes first. A chain is then eliminated from both
    // ends in turn, and neither end depends on the other's results.
    const auto is_later = [](const Candidate& x, const Candidate& y) {
        return x.weight != y.weight ? x.weight > y.weight : x.sequence > y.sequence;
    };
    std::uint32_t sequence = 0;
    const auto offer = [&](std::uint32_t node) {
        if (can_eliminate(node)) {
            candidates_.push_back({weight_of(node), sequence++, node});
            std::ranges::push_heap(candidates_, is_later);
        }
    };
    order_.clear();
    panels_.clear();
    eliminated_.assign(count, 0);
    candidates_.clear();
    for (std::uint32_t node = 0; node < count; ++node) {
        offer(node);
    }
    while (!candidates_.empty()) {
        std::ranges::pop_heap(candidates_, is_later);
        const Candidate candidate = candidates_.back();
        candidates_.pop_back();
        if (eliminated_[candidate.node] != 0 || candidate.weight != weight_of(candidate.node)) {
            continue;  // stale: was offered again when its neighbours changed
        }
        eliminate(candidate.node);
        for (const std::uint32_t other : neighbours_[candidate.node]) {
            offer(other);
        }
    }
    HH_CHECK(order_.size() == count, "every node is eliminated", order_.size());
    lay_out();
}

// The node's neighbours become neighbours of each other (fill). The node's own list is kept: it
// holds the blocks of its panel.
void EliminationPlan::eliminate(std::uint32_t node) {
    eliminated_[node] = 1;
    order_.push_back(node);
    const std::vector<std::uint32_t>& around = neighbours_[node];
    for (const std::uint32_t other : around) {
        std::vector<std::uint32_t>& of = neighbours_[other];
        merged_.clear();
        std::ranges::set_union(of, around, std::back_inserter(merged_));
        std::erase_if(merged_, [&](std::uint32_t x) { return x == other || x == node; });
        of.resize(merged_.size());  // unlike assign, keeps spare capacity
        std::ranges::copy(merged_, of.begin());
    }
}

// Lays out panels and their blocks in the order of elimination.
void EliminationPlan::lay_out() {
    panel_of_node_.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        panel_of_node_[order_[i]] = i;
    }
    blocks_.clear();
    std::uint32_t value = 0;
    std::uint32_t scalar = 0;
    for (const std::uint32_t node : order_) {
        Panel panel;
        panel.node = node;
        panel.width = width_of(node);
        panel.begin = value;
        panel.scalar = scalar;
        panel.blocks_begin = static_cast<std::uint32_t>(blocks_.size());
        for (const std::uint32_t other : neighbours_[node]) {
            blocks_.push_back({panel_of_node_[other], 0});
        }
        std::sort(blocks_.begin() + panel.blocks_begin, blocks_.end(),
                  [](const Block& x, const Block& y) { return x.panel < y.panel; });
        panel.blocks_end = static_cast<std::uint32_t>(blocks_.size());
        panel.stride = panel.width;
        for (std::uint32_t i = panel.blocks_begin; i < panel.blocks_end; ++i) {
            blocks_[i].column = panel.stride;
            panel.stride += width_of(order_[blocks_[i].panel]);
        }
        value += panel.width * panel.stride;
        scalar += panel.width;
        panels_.push_back(panel);
    }
    value_count_ = value;
    scalar_count_ = scalar;
}

// First column of the node of panel `later` in the rows of `panel`; 0 for the panel's own node.
std::uint32_t EliminationPlan::column_of(const Panel& panel, std::uint32_t later) const {
    const std::span<const Block> of = blocks(panel);
    const auto found = std::ranges::lower_bound(of, later, {}, &Block::panel);
    return found != of.end() && found->panel == later ? found->column : 0;
}

void EliminationPlan::find_updates() {
    updates_.clear();
    for (Panel& panel : panels_) {
        panel.updates = static_cast<std::uint32_t>(updates_.size());
        const std::span<const Block> of = blocks(panel);
        for (std::size_t x = 0; x < of.size(); ++x) {
            const Panel& target = panels_[of[x].panel];
            updates_.push_back(target.begin);
            for (std::size_t y = x + 1; y < of.size(); ++y) {
                updates_.push_back(target.begin + column_of(target, of[y].panel));
            }
        }
    }
}

void EliminationPlan::find_couplings() {
    couplings_.clear();
    hub_couplings_.clear();
    for (std::uint32_t slot = 0; slot < can_rotate_.size(); ++slot) {
        const std::uint32_t hub = hub_of_slot_[slot];
        for (std::uint32_t i = ends_begin_[slot]; i < ends_begin_[slot + 1]; ++i) {
            const std::uint32_t place = panel_of_node_[ends_[i] / 2];
            if (hub != k_no_slot) {
                const std::uint32_t hub_place = panel_of_node_[nodes_.size() + hub];
                const bool hub_first = hub_place < place;
                const Panel& panel = panels_[std::min(place, hub_place)];
                hub_couplings_.push_back(
                    {ends_[i], panel.begin + column_of(panel, std::max(place, hub_place)),
                     panel.stride, hub_first});
                continue;
            }
            for (std::uint32_t j = ends_begin_[slot]; j <= i; ++j) {
                const std::uint32_t other = panel_of_node_[ends_[j] / 2];
                const bool first = place < other;
                const Panel& panel = panels_[std::min(place, other)];
                couplings_.push_back({first ? ends_[i] : ends_[j], first ? ends_[j] : ends_[i],
                                      panel.begin + column_of(panel, std::max(place, other)),
                                      panel.stride});
            }
        }
    }
    for (std::uint32_t i = 0; i < hubs_.size(); ++i) {
        const Panel& panel = panels_[panel_of_node_[nodes_.size() + i]];
        hubs_[i].target = panel.begin;
        hubs_[i].stride = panel.stride;
    }
}

void EliminationPlan::find_appearances() {
    appearances_begin_.assign(order_.size() + 1, 0);
    for (const Block& block : blocks_) {
        ++appearances_begin_[panels_[block.panel].node + 1];
    }
    for (std::size_t i = 1; i < appearances_begin_.size(); ++i) {
        appearances_begin_[i] += appearances_begin_[i - 1];
    }
    appearances_.resize(blocks_.size());
    std::vector<std::uint32_t>& next = merged_;
    next.assign(appearances_begin_.begin(), appearances_begin_.end() - 1);
    for (const Panel& panel : panels_) {
        for (const Block& block : blocks(panel)) {
            appearances_[next[panels_[block.panel].node]++] = {panel.begin + block.column,
                                                               panel.width, panel.stride};
        }
    }
}

}  // namespace handhold
