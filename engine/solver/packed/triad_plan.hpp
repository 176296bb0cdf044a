// Solver, packed: the symbolic half of the packed LDL^T. Terms are defined in triad_system.hpp.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/packed/strand_plan.hpp"
#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// Elimination order and memory layout of a sparse LDL^T whose blocks are all 3x3: strands first,
// then the rest (all other nodes) in the order of an EliminationPlan. Also maps groups of four
// bodies to the ends of their triads, and to the blocks that these ends contribute to.
//
// Unless noted, nodes, ends (2 * node + side), steps and blocks are those of the rest. A node's
// number is its index in rest(). "Given" nodes are those passed to `build`.
class TriadPlan {
  public:
    // Preconditions: every node is three rows wide; no body has more than k_hub_nodes nodes.
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Reserves the capacities of `other`, so that building the same structure does not allocate.
    void reserve(const TriadPlan& other);
    // True if the plan was built from the same input.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) const;

    // The elimination of one node. Its diagonal block is followed by its blocks with the later
    // nodes that it is coupled with.
    struct Step {
        std::uint32_t node = 0;
        std::uint32_t own = 0;
        std::uint32_t later_begin = 0;  // index into later()
        std::uint32_t later_end = 0;
        // Into updates(): one target block for each pair (x, y) of later nodes, x <= y, by x, then
        // by y.
        std::uint32_t updates = 0;
        bool is_independent = false;  // not coupled with the node of the previous step
    };
    std::span<const Step> steps() const { return steps_; }
    std::span<const std::uint32_t> later(const Step& step) const {
        return std::span(later_).subspan(step.later_begin, step.later_end - step.later_begin);
    }
    // The later nodes of each step, one step after another.
    std::span<const std::uint32_t> later() const { return later_; }
    std::span<const std::uint32_t> updates() const { return updates_; }
    std::size_t block_count() const { return block_count_; }

    // One number per lane. Lane l of group g is the body at place 4 * g + l.
    using Lanes = StrandPlan::Lanes;
    static constexpr std::size_t k_lanes = std::tuple_size_v<Lanes>;
    // By node of the rest: the given node.
    std::span<const std::uint32_t> rest() const { return strands_.rest(); }
    // By slot: the body's place, 4 * group + lane. Rows of strands are the first groups.
    std::span<const std::uint32_t> places() const { return places_; }
    // By place: the slot; k_no_slot where a strand starts at an immovable body.
    std::span<const std::uint32_t> slots() const { return slots_; }
    std::size_t group_count() const { return strands_.row_count() + groups_.size(); }
    // Ends of the packed bodies, as 2 * given node + side. Each entry holds one end for each of
    // four bodies. Each row of a strand pack has two entries: the ends of its bodies at the
    // previous link and at the next link. `before` takes the place of the previous link of the
    // first row, and `after` that of the next link of the last row. The entries of ends() follow.
    // k_no_slot: the body in this lane has no such end.
    std::span<const Lanes> packed_ends() const { return packed_ends_; }

    // Four strands, one per lane. A row holds one body of each strand.
    struct StrandPack {
        std::uint32_t length = 0;  // links per strand: one less than rows
        std::uint32_t row = 0;     // index of the first group of four bodies
        std::uint32_t step = 0;    // first of its `length` steps; a step eliminates four links
        // First of its length + 2 elements in TriadArrays::multipliers: those of `before`, of each
        // step and of `after`.
        std::uint32_t bound = 0;
        Lanes
            before{};   // one per lane: end of a node of the rest at the first body, or dummy_end()
        Lanes after{};  // same, at the last body
        // By lane: blocks of `before`, of `after` and between both, or dummy_block(). The
        // elimination of the strand changes them.
        Lanes block_before{};
        Lanes block_after{};
        Lanes block_between{};
        // true: the rows of block_between are those of `before`; false: of `after`
        std::array<bool, 4> before_first{};
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    // By step k of a strand pack and lane: 2 * (given node of the link) + its side at row k.
    std::span<const Lanes> links(const StrandPack& strand_pack) const {
        return strands_.links().subspan(strand_pack.step, strand_pack.length);
    }
    std::size_t strand_pack_steps() const { return strands_.links().size(); }
    // First end of a strand that starts at an immovable body, and the place of the body that is
    // packed instead of it (see TriadSystem::Anchor).
    struct AnchoredEnd {
        std::uint32_t end = 0;
        std::uint32_t place = 0;
    };
    std::span<const AnchoredEnd> anchored_ends() const { return anchored_ends_; }
    // For each node passed to build: its index in rest(); k_no_slot if it is in a strand
    // (strand_plan.hpp).
    std::span<const std::uint32_t> rest_places() const { return strands_.places(); }

    // Four bodies in no strand. Each has up to `width` ends (2 * node + side), in the order in
    // which their nodes are eliminated. Missing ends are dummy_end().
    struct Group {
        std::uint32_t width = 0;
        std::uint32_t group_index = 0;  // index among all groups; rows of strands come first
        std::uint32_t packed = 0;       // index into packed_ends()
        std::uint32_t ends = 0;         // index into ends() of the first of `width` entries
        // Into TriadPlan::pairs(): one pair for each two of a body's ends, in the order of
        // Step::updates: (0, 0), (0, 1) .. (1, 1), (1, 2) ..
        std::uint32_t pairs = 0;
    };
    // By lane: the block to which the product of two ends is added, or dummy_block().
    struct Pair {
        Lanes blocks{};
        bool is_alone = false;  // no other product is added to any of these blocks
    };
    std::span<const Group> groups() const { return groups_; }
    std::span<const Lanes> ends() const { return ends_; }
    std::span<const Pair> pairs() const { return pairs_; }
    // Blocks that must be set to 0 before products are added.
    std::span<const std::uint32_t> zeros() const { return zeros_; }
    // Dummies: indices one past the last end and block.
    std::uint32_t dummy_end() const { return static_cast<std::uint32_t>(2 * steps_.size()); }
    std::uint32_t dummy_block() const { return static_cast<std::uint32_t>(block_count_); }

  private:
    static auto buffers(auto& plan) {
        return std::tie(plan.nodes_, plan.can_rotate_, plan.steps_, plan.later_, plan.updates_,
                        plan.strand_packs_, plan.anchored_ends_, plan.places_, plan.slots_,
                        plan.packed_ends_, plan.groups_, plan.ends_, plan.pairs_, plan.zeros_,
                        plan.place_in_body_, plan.counts_, plan.is_written_);
    }
    void take_steps();
    void find_places();
    void find_groups();
    void find_pairs();
    void find_strand_packs();
    void find_strand_blocks(const EliminationPlan::Coupling& coupling, std::uint32_t strand);
    void find_zeros();
    void pack_ends();
    std::uint32_t slot_of(std::uint32_t end) const {
        return strands_.rest_nodes()[end / 2].slots[end % 2];
    }

    std::vector<RowNode> nodes_;  // nodes as given by the caller
    std::vector<std::uint8_t> can_rotate_;
    StrandPlan strands_;
    EliminationPlan plan_;  // plan of the nodes of the rest
    std::vector<Step> steps_;
    std::vector<std::uint32_t> later_;  // nodes
    std::vector<std::uint32_t> updates_;
    std::vector<StrandPack> strand_packs_;
    std::vector<AnchoredEnd> anchored_ends_;
    std::vector<std::uint32_t> places_;
    std::vector<std::uint32_t> slots_;
    std::vector<Lanes> packed_ends_;
    std::vector<Group> groups_;
    std::vector<Lanes> ends_;
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> zeros_;
    std::vector<std::uint32_t> place_in_body_;  // position of each end among its body's ends
    std::size_t block_count_ = 0;

    // Scratch of build.
    // First the ends of each slot, later the products that write each block.
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint8_t> is_written_;  // indexed by block
};

}  // namespace handhold
