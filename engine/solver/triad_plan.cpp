#include "engine/solver/triad_plan.hpp"

#include <algorithm>

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
        steps_.push_back({panel.node, block_at(panel, panel.begin), begin, end, updates});
    }
    block_count_ = plan_.value_count() / k_block_size;
    find_sums();
}

void TriadPlan::find_sums() {
    struct Target {
        std::uint32_t block = 0;
        Coupling coupling;
    };
    std::vector<Target> targets;
    for (const EliminationPlan::Coupling& coupling : plan_.couplings()) {
        const EliminationPlan::Panel& panel = plan_.panel_of(coupling.panel_end / 2);
        targets.push_back(
            {block_at(panel, coupling.target), {coupling.panel_end, coupling.later_end}});
    }
    std::ranges::stable_sort(targets, {}, &Target::block);
    couplings_.clear();
    sums_.clear();
    fill_in_.clear();
    auto next = targets.begin();
    for (std::uint32_t block = 0; block < block_count_; ++block) {
        const auto begin = next;
        for (; next != targets.end() && next->block == block; ++next) {
            couplings_.push_back(next->coupling);
        }
        if (next == begin) {
            fill_in_.push_back(block);
        } else {
            sums_.push_back({block, static_cast<std::uint32_t>(couplings_.size())});
        }
    }
}

}  // namespace handhold
