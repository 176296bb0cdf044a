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
// then the rest in the order of an EliminationPlan. Also maps groups of four bodies to the
// ends of their triads and to the blocks that they contribute to.
//
// Nodes, ends (2 * node + side), steps and blocks are those of the rest, numbered by their index in
// `rest()`. "Given" nodes are those passed to `build`.
class TriadPlan {
  public:
    // Every node must be three rows wide; no body may have more than k_hub_nodes of them.
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Reserves the other plan's capacities, so that a build of its structure does not allocate.
    void reserve(const TriadPlan& other);
    // True if the plan was built from the same input.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) const;

    // The elimination of one node. Its own block is followed by its blocks with the later nodes
    // that it is coupled with.
    struct Step {
        std::uint32_t node = 0;
        std::uint32_t own = 0;
        std::uint32_t later_begin = 0;  // into `later`
        std::uint32_t later_end = 0;
        // Into `updates`: one target for each pair of its later nodes, (0, 0), (0, 1) .. (1, 1),
        // (1, 2) ..
        std::uint32_t updates = 0;
        bool is_independent = false;  // not coupled with the node of the step before
    };
    std::span<const Step> steps() const { return steps_; }
    std::span<const std::uint32_t> later(const Step& step) const {
        return std::span(later_).subspan(step.later_begin, step.later_end - step.later_begin);
    }
    std::span<const std::uint32_t> later() const { return later_; }  // of all steps, concatenated
    std::span<const std::uint32_t> updates() const { return updates_; }
    std::size_t block_count() const { return block_count_; }

    // One number per lane. Lane l of group g is the body at place 4 * g + l.
    using Lanes = StrandPlan::Lanes;
    static constexpr std::size_t k_lanes = std::tuple_size_v<Lanes>;
    // Given node of each node of the rest.
    std::span<const std::uint32_t> rest() const { return strands_.rest(); }
    // Place of a slot's body, 4 * group + lane. Rows of strands come first.
    std::span<const std::uint32_t> places() const { return places_; }
    // By place: the slot; k_no_slot if a strand has no body there.
    std::span<const std::uint32_t> slots() const { return slots_; }
    std::size_t group_count() const { return strands_.row_count() + groups_.size(); }
    // Ends of given nodes in the order in which they are packed, four bodies each: two for
    // each row of a strand (that of the link before, that of the link after), then `ends()`.
    // k_no_slot: none in this lane.
    std::span<const Lanes> packed_ends() const { return packed_ends_; }

    // Four strands. A row has four bodies.
    struct StrandPack {
        std::uint32_t length = 0;  // links per strand: one less than rows
        std::uint32_t row = 0;     // its first row, into the groups of four bodies
        std::uint32_t step = 0;    // first of its `length` steps; a step eliminates four links
        // First of its length + 2 quadruples of multipliers: those of `before`, of each step and of
        // `after`.
        std::uint32_t bound = 0;
        Lanes before{};  // the rest's end at the first body, or `dummy_end`
        Lanes after{};   // the same at the last body
        // Blocks to which the strand's remainder is added, or `dummy_block`.
        Lanes block_before{};
        Lanes block_after{};
        Lanes block_between{};
        std::array<bool, 4> before_first{};  // rows of `block_between` are those of `before`
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    // Given nodes of a strand pack's steps: 2 * node + the side at row k.
    std::span<const Lanes> links(const StrandPack& strand_pack) const {
        return strands_.links().subspan(strand_pack.step, strand_pack.length);
    }
    std::size_t strand_pack_steps() const { return strands_.links().size(); }
    // A strand's first end if it is at an immovable body, and the place of the stand-in body for
    // it.
    struct AnchoredEnd {
        std::uint32_t end = 0;
        std::uint32_t place = 0;
    };
    std::span<const AnchoredEnd> anchored_ends() const { return anchored_ends_; }
    // Index of a given node in `rest()`; k_no_slot for a strand's.
    std::span<const std::uint32_t> rest_places() const { return strands_.places(); }

    // Four bodies of the rest. Each has up to `width` ends (2 * node + side), those of earlier
    // eliminated nodes first; missing ones are `dummy_end`.
    struct Group {
        std::uint32_t width = 0;
        std::uint32_t group_index = 0;  // into groups of four bodies, rows of strands first
        std::uint32_t packed = 0;       // into `packed_ends`
        std::uint32_t ends = 0;         // into `ends`, `width` of them
        // into `pairs`, ordered as Step::updates: products of two of its ends
        std::uint32_t pairs = 0;
    };
    // Target blocks of a product, or `dummy_block`.
    struct Pair {
        Lanes blocks{};
        bool is_alone = false;  // no other product is added to any of these
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

    std::vector<RowNode> nodes_;  // as given
    std::vector<std::uint8_t> can_rotate_;
    StrandPlan strands_;
    EliminationPlan plan_;  // of the rest
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
    std::vector<std::uint32_t> place_in_body_;  // by end: its index among its body's ends
    std::size_t block_count_ = 0;

    // Scratch of build.
    std::vector<std::uint32_t> counts_;     // ends per slot, then products per block
    std::vector<std::uint8_t> is_written_;  // by block
};

}  // namespace handhold
