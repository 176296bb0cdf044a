#include "engine/solver/triad_plan.hpp"

#include <algorithm>
#include <tuple>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_rows = 3;
constexpr std::size_t k_block_size = 9;

// A panel's rows are `stride` long, its blocks lie beside each other; here they follow each other.
std::uint32_t block_at(const EliminationPlan::Panel& panel, std::uint32_t value) {
    return panel.begin / (k_rows * k_rows) + (value - panel.begin) / k_rows;
}

}  // namespace

void TriadPlan::build(std::span<const RowNode> nodes, std::span<const std::uint8_t> turns) {
    plan_.build(nodes, turns);
    HH_CHECK(plan_.hubs().empty(), "hubs have no triads", plan_.hubs().size());
    const std::span<const EliminationPlan::Panel> panels = plan_.panels();
    steps_.clear();
    later_.clear();
    updates_.clear();
    for (const EliminationPlan::Panel& panel : panels) {
        const auto begin = static_cast<std::uint32_t>(later_.size());
        const std::uint32_t* target = plan_.updates().data() + panel.updates;
        const auto updates = static_cast<std::uint32_t>(updates_.size());
        const std::span<const EliminationPlan::Block> blocks = plan_.blocks(panel);
        for (std::size_t x = 0; x < blocks.size(); ++x) {
            const EliminationPlan::Panel& row_panel = panels[blocks[x].panel];
            later_.push_back(row_panel.node);
            for (std::size_t y = x; y < blocks.size(); ++y) {
                updates_.push_back(block_at(row_panel, *target++));
            }
        }
        const auto end = static_cast<std::uint32_t>(later_.size());
        const bool is_independent =
            !steps_.empty() &&
            std::ranges::find(later(steps_.back()), panel.node) == later(steps_.back()).end();
        steps_.push_back(
            {panel.node, block_at(panel, panel.begin), begin, end, updates, is_independent});
    }
    block_count_ = plan_.value_count() / k_block_size;
    find_groups(nodes, turns.size());
    find_pairs(nodes);
    find_zeros();
}

// Nodes that go first come first: a product's block lies in the panel of the earlier of its two.
void TriadPlan::find_groups(std::span<const RowNode> nodes, std::size_t bodies) {
    constexpr std::size_t k_lanes = std::tuple_size_v<Lanes>;
    std::vector<std::uint32_t> counts(bodies, 0);
    place_in_body_.assign(2 * nodes.size(), 0);
    for (const Step& step : steps_) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t slot = nodes[step.node].slots[side];
            if (slot != k_no_slot) {
                place_in_body_[2 * step.node + side] = counts[slot]++;
            }
        }
    }
    groups_.clear();
    std::uint32_t ends = 0;
    std::uint32_t pairs = 0;
    for (std::size_t body = 0; body < bodies; body += k_lanes) {
        const std::size_t lanes = std::min(k_lanes, bodies - body);
        const std::uint32_t width = std::ranges::max(std::span(counts).subspan(body, lanes));
        groups_.push_back({width, ends, pairs});
        ends += width;
        pairs += width * (width + 1) / 2;
    }
    Lanes spare;
    spare.fill(spare_end());
    ends_.assign(ends, spare);
    spare.fill(spare_block());
    pairs_.assign(pairs, {spare});
    for (std::uint32_t end = 0; end < spare_end(); ++end) {
        const std::uint32_t slot = nodes[end / 2].slots[end % 2];
        if (slot != k_no_slot) {
            ends_[groups_[slot / k_lanes].ends + place_in_body_[end]][slot % k_lanes] = end;
        }
    }
}

void TriadPlan::find_pairs(std::span<const RowNode> nodes) {
    for (const EliminationPlan::Coupling& coupling : plan_.couplings()) {
        const std::uint32_t row = place_in_body_[coupling.panel_end];
        const std::uint32_t column = place_in_body_[coupling.later_end];
        const std::uint32_t slot = nodes[coupling.panel_end / 2].slots[coupling.panel_end % 2];
        const Group& group = groups_[slot / 4];
        // Rows before this one have one pair less each.
        const std::uint32_t before = row * group.width - row * (row + 1) / 2;
        pairs_[group.pairs + before + column].blocks[slot % 4] =
            block_at(plan_.panel_of(coupling.panel_end / 2), coupling.target);
    }
}

void TriadPlan::find_zeros() {
    std::vector<std::uint32_t> sums(block_count_ + 1, 0);
    for (const Pair& pair : pairs_) {
        for (const std::uint32_t block : pair.blocks) {
            ++sums[block];
        }
    }
    sums[spare_block()] = 1;
    std::vector<std::uint8_t> is_written(block_count_ + 1, 0);
    for (Pair& pair : pairs_) {
        pair.is_alone = std::ranges::all_of(
            pair.blocks, [&sums](std::uint32_t block) { return sums[block] == 1; });
        if (pair.is_alone) {
            for (const std::uint32_t block : pair.blocks) {
                is_written[block] = 1;
            }
        }
    }
    is_written[spare_block()] = 0;
    zeros_.clear();
    for (std::uint32_t block = 0; block <= spare_block(); ++block) {
        if (is_written[block] == 0) {
            zeros_.push_back(block);
        }
    }
}

}  // namespace handhold
