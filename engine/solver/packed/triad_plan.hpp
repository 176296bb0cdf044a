#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/packed/strand_plan.hpp"
#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// The symbolic half of a sparse LDL^T whose blocks are all three by three: the strands of long
// runs, which go first; of the rest an EliminationPlan's order for nodes three rows wide, and
// blocks numbered one after the other; and where four bodies at a time find the ends of their rows
// and the blocks that they add to.
//
// Nodes, ends (2 * node + side), steps and blocks are the rest's, numbered by their places in
// `rest()`, but where the given nodes are spoken of.
class TriadPlan {
  public:
    // `nodes` each three rows wide, no body with more than k_hub_nodes of them.
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Room for what the other has room for: a build of its structure allocates nothing.
    void reserve(const TriadPlan& other);
    // True where it was built from the same.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) const;

    // A node is eliminated: its own block, and the blocks of the later nodes that it meets, which
    // follow it.
    struct Step {
        std::uint32_t node = 0;
        std::uint32_t own = 0;
        std::uint32_t later_begin = 0;  // into `later`
        std::uint32_t later_end = 0;
        std::uint32_t updates = 0;    // into `updates`: a target for each two of its later nodes,
                                      // (0, 0), (0, 1) .. (1, 1), (1, 2) ..
        bool is_independent = false;  // of the step before: it does not meet that one's node
    };
    std::span<const Step> steps() const { return steps_; }
    std::span<const std::uint32_t> later(const Step& step) const {
        return std::span(later_).subspan(step.later_begin, step.later_end - step.later_begin);
    }
    std::span<const std::uint32_t> later() const { return later_; }  // of all steps
    std::span<const std::uint32_t> updates() const { return updates_; }
    std::size_t block_count() const { return block_count_; }

    // One number a lane; a lane has a body, the one at place 4 * four + lane.
    using Lanes = StrandPlan::Lanes;
    static constexpr std::size_t k_lanes = std::tuple_size_v<Lanes>;
    // The given node of each of the rest's.
    std::span<const std::uint32_t> rest() const { return strands_.rest(); }
    // Where the body of a slot stands: 4 * its four + its lane. Rows of strands come first.
    std::span<const std::uint32_t> places() const { return places_; }
    // By place: the slot; k_no_slot where a strand has no body.
    std::span<const std::uint32_t> slots() const { return slots_; }
    std::size_t four_count() const { return strands_.row_count() + groups_.size(); }
    // The given nodes' ends (2 * node + side), of four bodies each, as they are packed: two for
    // each row of a strand, that of the node before and that of the one after, then `ends()`.
    // k_no_slot where a lane has none.
    std::span<const Lanes> packed_ends() const { return packed_ends_; }

    // Four strands. A row has four bodies.
    struct StrandPack {
        std::uint32_t length = 0;  // links of each: one less than rows
        std::uint32_t row = 0;     // the first: of fours of bodies
        std::uint32_t step = 0;    // the first of its length steps, in which four links go
        std::uint32_t bound = 0;   // the first of length + 2 of its fours of multipliers: those
                                   // of `before`, of each step and of `after`
        Lanes before{};            // the end at the first body, or `dummy_end`
        Lanes after{};             // and at the last one
        // What is left of a strand is added there, or to `dummy_block`.
        Lanes block_before{};
        Lanes block_after{};
        Lanes block_between{};
        std::array<bool, 4> before_first{};  // rows of `block_between` are those of `before`
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    // The given nodes of a braid's steps: 2 * node + the side at the row before.
    std::span<const Lanes> links(const StrandPack& strand_pack) const {
        return strands_.links().subspan(strand_pack.step, strand_pack.length);
    }
    std::size_t strand_pack_steps() const { return strands_.links().size(); }
    // Ends of given nodes that nothing moves at the beginning of a strand, and the place of the
    // body that stands for it there.
    struct AnchoredEnd {
        std::uint32_t end = 0;
        std::uint32_t place = 0;
    };
    std::span<const AnchoredEnd> anchored_ends() const { return anchored_ends_; }
    // The place of a given node in `rest()`; k_no_slot for a strand's.
    std::span<const std::uint32_t> rest_places() const { return strands_.places(); }

    // Four bodies of the rest. Each has up to `width` ends (2 * node + side), those of the nodes
    // that go first before the others; what a lane lacks is `dummy_end`.
    struct Group {
        std::uint32_t width = 0;
        std::uint32_t four = 0;    // which four bodies
        std::uint32_t packed = 0;  // into `packed_ends`
        std::uint32_t ends = 0;    // into `ends`, `width` of them
        std::uint32_t pairs = 0;   // into `pairs`, as Step::updates: products of two of its ends
    };
    // Where they go, or `dummy_block`.
    struct Pair {
        Lanes blocks{};
        bool is_alone = false;  // nothing else is added to any of these
    };
    std::span<const Group> groups() const { return groups_; }
    std::span<const Lanes> ends() const { return ends_; }
    std::span<const Pair> pairs() const { return pairs_; }
    // Blocks that are 0 before products are added.
    std::span<const std::uint32_t> zeros() const { return zeros_; }
    // One past those that are.
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
    std::vector<std::uint32_t> place_in_body_;  // by end
    std::size_t block_count_ = 0;

    // Scratch of build.
    std::vector<std::uint32_t> counts_;     // ends by slot, then sums by block
    std::vector<std::uint8_t> is_written_;  // by block
};

}  // namespace handhold
