#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/elimination_plan.hpp"

namespace handhold {

// The symbolic half of a sparse LDL^T whose blocks are all three by three: an EliminationPlan's
// order for nodes three rows wide, and blocks numbered one after the other; and where four bodies
// at a time find the ends of their rows and the blocks that they add to.
class TriadPlan {
  public:
    // `nodes` each three rows wide, no body with more than k_hub_nodes of them.
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> turns);
    // True where it was built from the same.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> turns) const {
        return plan_.fits(nodes, turns);
    }

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

    // One number a lane; a lane has a body, the one of slot 4 * group + lane.
    using Lanes = std::array<std::uint32_t, 4>;
    // Four bodies. Each has up to `width` ends (2 * node + side), those of the nodes that go first
    // before the others; what a lane lacks is `spare_end`.
    struct Group {
        std::uint32_t width = 0;
        std::uint32_t ends = 0;   // into `ends`, `width` of them
        std::uint32_t pairs = 0;  // into `pairs`, as Step::updates: products of two of its ends
    };
    // Where they go, or `spare_block`.
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
    std::uint32_t spare_end() const { return static_cast<std::uint32_t>(2 * steps_.size()); }
    std::uint32_t spare_block() const { return static_cast<std::uint32_t>(block_count_); }

  private:
    void find_groups(std::span<const RowNode> nodes, std::size_t bodies);
    void find_pairs(std::span<const RowNode> nodes);
    void find_zeros();

    EliminationPlan plan_;
    std::vector<Step> steps_;
    std::vector<std::uint32_t> later_;  // nodes
    std::vector<std::uint32_t> updates_;
    std::vector<Group> groups_;
    std::vector<Lanes> ends_;
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> zeros_;
    std::vector<std::uint32_t> place_in_body_;  // by end
    std::size_t block_count_ = 0;
};

}  // namespace handhold
