#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/elimination_plan.hpp"

namespace handhold {

// The symbolic half of a sparse LDL^T whose blocks are all three by three: an EliminationPlan's
// order for nodes three rows wide, and blocks numbered one after the other.
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
        std::uint32_t updates = 0;  // into `updates`: a target for each two of its later nodes,
                                    // (0, 0), (0, 1) .. (1, 1), (1, 2) ..
    };
    // A product of two nodes that share a body: rows of the one, columns of the other.
    struct Coupling {
        std::uint32_t row_end = 0;  // 2 * node + side
        std::uint32_t column_end = 0;
    };

    std::span<const Step> steps() const { return steps_; }
    std::span<const std::uint32_t> later(const Step& step) const {
        return std::span(later_).subspan(step.later_begin, step.later_end - step.later_begin);
    }
    std::span<const std::uint32_t> updates() const { return updates_; }
    // A block: the sum of couplings, from where the sum before ends.
    struct Sum {
        std::uint32_t target = 0;  // block
        std::uint32_t end = 0;     // into `couplings`
    };
    std::span<const Coupling> couplings() const { return couplings_; }
    std::span<const Sum> sums() const { return sums_; }
    // Blocks that no coupling reaches: they are filled by the elimination alone.
    std::span<const std::uint32_t> fill_in() const { return fill_in_; }
    std::size_t block_count() const { return block_count_; }

  private:
    void find_sums();

    EliminationPlan plan_;
    std::vector<Step> steps_;
    std::vector<std::uint32_t> later_;  // nodes
    std::vector<std::uint32_t> updates_;
    std::vector<Coupling> couplings_;
    std::vector<Sum> sums_;
    std::vector<std::uint32_t> fill_in_;
    std::size_t block_count_ = 0;
};

}  // namespace handhold
