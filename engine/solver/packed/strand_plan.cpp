// Solver, packed: finds strands in an island's chains.
// Source: nested dissection after George, Nested Dissection of a Regular Finite Element Mesh
// (1973), applied to a path.
#include "engine/solver/packed/strand_plan.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr std::uint32_t k_strands = 4;
constexpr std::uint32_t k_separators = k_strands - 1;
// Shorter strands cost more for their separators than they save.
constexpr std::uint32_t k_shortest_strand = 4;

// An end is one side of a node: 2 * node + side. Returns the other side of the same node.
std::uint32_t other_side(std::uint32_t end) { return end ^ 1U; }

}  // namespace

void StrandPlan::reserve(const StrandPlan& other) { reserve_as(buffers(other), buffers(*this)); }

void StrandPlan::build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) {
    slot_count_ = can_rotate.size();
    strand_packs_.clear();
    bodies_.clear();
    links_.clear();
    places_.assign(nodes.size(), 0);
    strand_of_slot_.assign(slot_count_, k_no_slot);
    find_ends(nodes);
    find_links(nodes);
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        if (is_open_[node] != 0) {
            follow(nodes, node);
            cut(nodes);
        }
    }
    lay_out_rest(nodes, can_rotate);
}

void StrandPlan::find_ends(std::span<const RowNode> nodes) {
    ends_.assign(slot_count_, {k_no_slot, k_no_slot});
    uses_.assign(slot_count_, 0);
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t slot = nodes[node].slots[side];
            if (slot == k_no_slot) {
                continue;
            }
            if (uses_[slot] < 2) {
                ends_[slot][uses_[slot]] = 2 * node + side;
            }
            ++uses_[slot];
        }
    }
}

// Marks the nodes that a strand may run through: point links whose two bodies each have at most one
// node besides this one.
void StrandPlan::find_links(std::span<const RowNode> nodes) {
    is_open_.assign(nodes.size(), 0);
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        const auto is_passable = [&](std::uint32_t slot) {
            return slot == k_no_slot || uses_[slot] <= 2;
        };
        const std::uint32_t a = nodes[node].slots[0];
        const std::uint32_t b = nodes[node].slots[1];
        is_open_[node] =
            nodes[node].is_point_link && a != b && is_passable(a) && is_passable(b) ? 1 : 0;
    }
}

// The end of the other node at the same body; k_no_slot if there is none.
std::uint32_t StrandPlan::beyond(std::span<const RowNode> nodes, std::uint32_t end) const {
    const std::uint32_t slot = nodes[end / 2].slots[end % 2];
    if (slot == k_no_slot || uses_[slot] < 2) {
        return k_no_slot;
    }
    return ends_[slot][0] == end ? ends_[slot][1] : ends_[slot][0];
}

// Collects in run_ all links of the run that contains link `from`, in order. In a closed run,
// `from` itself is left out and acts as a separator.
void StrandPlan::follow(std::span<const RowNode> nodes, std::uint32_t from) {
    const auto is_open = [this](std::uint32_t end) {
        return end != k_no_slot && is_open_[end / 2] != 0;
    };
    run_.clear();
    is_open_[from] = 0;
    std::uint32_t end = 2 * from;  // the end at which the run enters the link
    std::uint32_t back = beyond(nodes, end);
    while (is_open(back)) {
        is_open_[back / 2] = 0;
        end = other_side(back);
        back = beyond(nodes, end);
    }
    if (back != k_no_slot && back / 2 == from) {  // a closed run
        end = beyond(nodes, other_side(back));
        for (; end / 2 != from; end = beyond(nodes, other_side(end))) {
            run_.push_back(end);
        }
        return;
    }
    for (;;) {
        run_.push_back(end);
        if (end / 2 == from) {
            break;
        }
        end = beyond(nodes, other_side(end));
    }
    for (end = beyond(nodes, other_side(end)); is_open(end); end = beyond(nodes, other_side(end))) {
        is_open_[end / 2] = 0;
        run_.push_back(end);
    }
}

// Cuts the run into four strands, unless it is too short. Lanes 0 and 1 follow the run forwards,
// lanes 2 and 3 backwards, so that all four are eliminated towards the middle separator.
void StrandPlan::cut(std::span<const RowNode> nodes) {
    const auto size = static_cast<std::uint32_t>(run_.size());
    if (size < k_strands * k_shortest_strand + k_separators) {
        return;
    }
    const std::uint32_t length = (size - k_separators) / k_strands;
    // The links that remain are added to the separators.
    std::uint32_t spare = size - k_separators - k_strands * length;
    StrandPack strand_pack;
    strand_pack.length = length;
    strand_pack.row = static_cast<std::uint32_t>(bodies_.size());
    strand_pack.links = static_cast<std::uint32_t>(links_.size());
    Lanes none;
    none.fill(k_no_slot);
    strand_pack.before = strand_pack.after = none;
    strand_packs_.push_back(strand_pack);
    bodies_.resize(bodies_.size() + length + 1, none);
    links_.resize(links_.size() + length, none);
    std::uint32_t begin = 0;
    for (std::uint32_t lane = 0; lane < k_strands; ++lane) {
        const std::span<std::uint32_t> ends = std::span(run_).subspan(begin, length);
        begin += length + 1 + (spare > 0 ? 1 : 0);
        spare -= spare > 0 ? 1 : 0;
        if (lane >= k_strands / 2) {
            std::ranges::reverse(ends);
            std::ranges::transform(ends, ends.begin(), other_side);
        }
        add_strand(nodes, ends, lane);
    }
}

void StrandPlan::add_strand(std::span<const RowNode> nodes, std::span<const std::uint32_t> ends,
                            std::uint32_t lane) {
    StrandPack& strand_pack = strand_packs_.back();
    const auto strand =
        static_cast<std::uint32_t>(slot_count_ + k_strands * (strand_packs_.size() - 1)) + lane;
    const auto place = [&](std::uint32_t row, std::uint32_t end) {
        const std::uint32_t slot = nodes[end / 2].slots[end % 2];
        bodies_[strand_pack.row + row][lane] = slot;
        if (slot != k_no_slot) {
            strand_of_slot_[slot] = strand;
        }
    };
    for (std::uint32_t k = 0; k < ends.size(); ++k) {
        links_[strand_pack.links + k][lane] = ends[k];
        places_[ends[k] / 2] = k_no_slot;
        place(k, ends[k]);
    }
    place(strand_pack.length, other_side(ends.back()));
    // Stores nodes of the whole island; lay_out_rest converts them to indices in rest_.
    strand_pack.before[lane] = beyond(nodes, ends.front());
    strand_pack.after[lane] = beyond(nodes, other_side(ends.back()));
}

void StrandPlan::lay_out_rest(std::span<const RowNode> nodes,
                              std::span<const std::uint8_t> can_rotate) {
    rest_.clear();
    rest_nodes_.clear();
    rest_slots_.clear();
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        if (places_[node] == k_no_slot) {
            continue;
        }
        places_[node] = static_cast<std::uint32_t>(rest_.size());
        rest_.push_back(node);
        rest_nodes_.push_back(nodes[node]);
        for (std::uint32_t& slot : rest_nodes_.back().slots) {
            if (slot != k_no_slot && strand_of_slot_[slot] != k_no_slot) {
                slot = strand_of_slot_[slot];
            }
        }
    }
    for (StrandPack& strand_pack : strand_packs_) {
        for (Lanes* const ends : {&strand_pack.before, &strand_pack.after}) {
            for (std::uint32_t& end : *ends) {
                end = end == k_no_slot ? end : 2 * places_[end / 2] + end % 2;
            }
        }
    }
    rest_can_rotate_.assign(can_rotate.begin(), can_rotate.end());
    rest_can_rotate_.resize(slot_count_ + k_strands * strand_packs_.size(), 1);
    for (std::uint32_t slot = 0; slot < slot_count_; ++slot) {
        if (strand_of_slot_[slot] == k_no_slot) {
            rest_slots_.push_back(slot);
        }
    }
}

}  // namespace handhold
