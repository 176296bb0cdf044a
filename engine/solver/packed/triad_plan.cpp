// Solver, packed: symbolic factorisation of an island's triads.
#include "engine/solver/packed/triad_plan.hpp"

#include <algorithm>
#include <tuple>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_rows = 3;
constexpr std::size_t k_block_size = 9;

// Index into TriadPlan's blocks of the block whose first value is `value` in the panel. In a panel,
// blocks lie side by side in rows of length `stride`; in a TriadPlan they follow one another.
std::uint32_t block_at(const EliminationPlan::Panel& panel, std::uint32_t value) {
    return panel.begin / (k_rows * k_rows) + (value - panel.begin) / k_rows;
}

}  // namespace

bool TriadPlan::fits(std::span<const RowNode> nodes,
                     std::span<const std::uint8_t> can_rotate) const {
    return std::ranges::equal(nodes, nodes_) && std::ranges::equal(can_rotate, can_rotate_);
}

void TriadPlan::build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) {
    nodes_.assign(nodes.begin(), nodes.end());
    can_rotate_.assign(can_rotate.begin(), can_rotate.end());
    strands_.build(nodes, can_rotate);
    plan_.build(strands_.rest_nodes(), strands_.rest_can_rotate());
    HH_CHECK(plan_.hubs().empty(), "hubs have no triads", plan_.hubs().size());
    take_steps();
    find_places();
    find_groups();
    find_strand_packs();
    find_pairs();
    find_zeros();
    pack_ends();
}

void TriadPlan::reserve(const TriadPlan& other) {
    strands_.reserve(other.strands_);
    plan_.reserve(other.plan_);
    reserve_as(buffers(other), buffers(*this));
}

void TriadPlan::take_steps() {
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
}

void TriadPlan::find_places() {
    slots_.clear();
    for (const Lanes& row : strands_.bodies()) {
        slots_.insert(slots_.end(), row.begin(), row.end());
    }
    const std::span<const std::uint32_t> rest = strands_.rest_slots();
    slots_.insert(slots_.end(), rest.begin(), rest.end());
    places_.assign(can_rotate_.size(), k_no_slot);
    for (std::uint32_t place = 0; place < slots_.size(); ++place) {
        if (slots_[place] != k_no_slot) {
            places_[slots_[place]] = place;
        }
    }
}

// Forms groups of four bodies. Numbers each body's ends in the order in which their nodes are
// eliminated, because a product's block lies in the panel of the node eliminated first.
void TriadPlan::find_groups() {
    const std::span<const std::uint32_t> slots = strands_.rest_slots();
    counts_.assign(strands_.rest_can_rotate().size(), 0);
    place_in_body_.assign(dummy_end(), 0);
    for (const Step& step : steps_) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t slot = slot_of(2 * step.node + side);
            if (slot != k_no_slot) {
                place_in_body_[2 * step.node + side] = counts_[slot]++;
            }
        }
    }
    groups_.clear();
    auto group_index = static_cast<std::uint32_t>(strands_.row_count());
    const std::uint32_t packed = 2 * group_index;
    std::uint32_t ends = 0;
    std::uint32_t pairs = 0;
    for (std::size_t body = 0; body < slots.size(); body += k_lanes) {
        std::uint32_t width = 0;
        for (const std::uint32_t slot :
             slots.subspan(body, std::min(k_lanes, slots.size() - body))) {
            width = std::max(width, counts_[slot]);
        }
        groups_.push_back({width, group_index++, packed + ends, ends, pairs});
        ends += width;
        pairs += width * (width + 1) / 2;
    }
    Lanes dummy;
    dummy.fill(dummy_end());
    ends_.assign(ends, dummy);
    dummy.fill(dummy_block());
    pairs_.assign(pairs, {dummy});
    const auto first = static_cast<std::uint32_t>(strands_.row_count());
    for (std::uint32_t end = 0; end < dummy_end(); ++end) {
        const std::uint32_t slot = slot_of(end);
        if (slot < places_.size()) {
            const std::uint32_t place = places_[slot];
            const Group& group = groups_[place / k_lanes - first];
            ends_[group.ends + place_in_body_[end]][place % k_lanes] = end;
        }
    }
}

void TriadPlan::find_strand_packs() {
    strand_packs_.clear();
    anchored_ends_.clear();
    Lanes dummy;
    dummy.fill(dummy_block());
    const auto or_dummy = [this](Lanes ends) {
        std::ranges::replace(ends, k_no_slot, dummy_end());
        return ends;
    };
    for (const StrandPlan::StrandPack& from : strands_.strand_packs()) {
        const auto bound = static_cast<std::uint32_t>(from.links + 2 * strand_packs_.size());
        strand_packs_.push_back({from.length, from.row, from.links, bound, or_dummy(from.before),
                                 or_dummy(from.after), dummy, dummy, dummy});
        for (std::uint32_t lane = 0; lane < k_lanes; ++lane) {
            if (strands_.bodies()[from.row][lane] == k_no_slot) {
                anchored_ends_.push_back({strands_.links()[from.links][lane],
                                          static_cast<std::uint32_t>(k_lanes) * from.row + lane});
            }
        }
    }
}

void TriadPlan::find_pairs() {
    const auto first = static_cast<std::uint32_t>(strands_.row_count());
    for (const EliminationPlan::Coupling& coupling : plan_.couplings()) {
        const std::uint32_t slot = slot_of(coupling.panel_end);
        if (slot >= places_.size()) {
            find_strand_blocks(coupling, slot - static_cast<std::uint32_t>(places_.size()));
            continue;
        }
        const std::uint32_t row = place_in_body_[coupling.panel_end];
        const std::uint32_t column = place_in_body_[coupling.later_end];
        const Group& group = groups_[places_[slot] / k_lanes - first];
        // The pairs form an upper triangle: each line has one pair fewer than the line before.
        const std::uint32_t before = row * group.width - row * (row + 1) / 2;
        pairs_[group.pairs + before + column].blocks[places_[slot] % k_lanes] =
            block_at(plan_.panel_of(coupling.panel_end / 2), coupling.target);
    }
}

void TriadPlan::find_strand_blocks(const EliminationPlan::Coupling& coupling,
                                   std::uint32_t strand) {
    StrandPack& strand_pack = strand_packs_[strand / k_lanes];
    const std::size_t lane = strand % k_lanes;
    const std::uint32_t block = block_at(plan_.panel_of(coupling.panel_end / 2), coupling.target);
    const bool before_first = coupling.panel_end == strand_pack.before[lane];
    if (coupling.panel_end != coupling.later_end) {
        strand_pack.block_between[lane] = block;
        strand_pack.before_first[lane] = before_first;
    } else {
        (before_first ? strand_pack.block_before : strand_pack.block_after)[lane] = block;
    }
}

void TriadPlan::find_zeros() {
    counts_.assign(block_count_ + 1, 0);
    for (const Pair& pair : pairs_) {
        for (const std::uint32_t block : pair.blocks) {
            ++counts_[block];
        }
    }
    for (const StrandPack& strand_pack : strand_packs_) {
        for (const Lanes* const blocks :
             {&strand_pack.block_before, &strand_pack.block_after, &strand_pack.block_between}) {
            for (const std::uint32_t block : *blocks) {
                // Strands write to this block as well. A count of 2 says that a product is added to
                // it; only a block with a count of 1 may be overwritten.
                counts_[block] += 2;
            }
        }
    }
    counts_[dummy_block()] = 1;
    is_written_.assign(block_count_ + 1, 0);
    for (Pair& pair : pairs_) {
        pair.is_alone = std::ranges::all_of(
            pair.blocks, [this](std::uint32_t block) { return counts_[block] == 1; });
        if (pair.is_alone) {
            for (const std::uint32_t block : pair.blocks) {
                is_written_[block] = 1;
            }
        }
    }
    is_written_[dummy_block()] = 0;
    zeros_.clear();
    for (std::uint32_t block = 0; block <= dummy_block(); ++block) {
        if (is_written_[block] == 0) {
            zeros_.push_back(block);
        }
    }
}

void TriadPlan::pack_ends() {
    Lanes none;
    none.fill(k_no_slot);
    packed_ends_.assign(2 * strands_.row_count() + ends_.size(), none);
    const auto given = [this](std::uint32_t end) {
        return end == dummy_end() ? k_no_slot : 2 * rest()[end / 2] + end % 2;
    };
    for (const StrandPack& strand_pack : strand_packs_) {
        Lanes* const ends = packed_ends_.data() + std::size_t{2} * strand_pack.row;
        std::ranges::transform(strand_pack.before, ends[0].begin(), given);
        for (std::size_t k = 0; k < strand_pack.length; ++k) {
            ends[2 * k + 1] = links(strand_pack)[k];
            std::ranges::transform(ends[2 * k + 1], ends[2 * k + 2].begin(),
                                   [](std::uint32_t end) { return end ^ 1U; });
        }
        std::ranges::transform(strand_pack.after,
                               ends[std::size_t{2} * strand_pack.length + 1].begin(), given);
    }
    Lanes* ends = packed_ends_.data() + 2 * strands_.row_count();
    for (const Lanes& of_rest : ends_) {
        std::ranges::transform(of_rest, (ends++)->begin(), given);
    }
}

}  // namespace handhold
