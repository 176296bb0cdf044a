// Solver, sparse: the symbolic half of the sparse LDL^T, that is, the order in which the unknowns
// of an island are eliminated and the memory layout of the factor. Depends only on which rows share
// which bodies.

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace handhold {

// Maximum width of a node, in rows: four contacts with friction.
inline constexpr std::uint32_t k_widest_node = 12;
// Smallest pivot, relative to the diagonal. A row with a smaller pivot is linearly dependent on
// others to a degree that alpha cannot separate.
inline constexpr double k_smallest_pivot = 1e-14;
inline constexpr std::uint32_t k_hub_nodes = 4;  // bodies with more row nodes are hubs
inline constexpr std::uint32_t k_no_slot = std::numeric_limits<std::uint32_t>::max();

// Reserves in the vectors `here` the capacities of the vectors `other`; both are std::tie.
template <typename Here, typename Other>
void reserve_as(const Other& other, Here&& here) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (std::get<I>(here).reserve(std::get<I>(other).capacity()), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<Other>>());
}

// A node of unknowns: the multipliers of all rows between the same two bodies.
struct RowNode {
    // Slots of a and b; k_no_slot for a body that cannot move.
    std::uint32_t slots[2] = {k_no_slot, k_no_slot};
    std::uint32_t width = 0;      // rows
    bool is_regularised = false;  // all rows have an alpha large enough as a pivot
    bool is_point_link = false;   // point triad of a joint; may be in a strand (packed/)
    bool operator==(const RowNode&) const = default;
};

// Nodes are numbered: row nodes in the order given, then hubs. A hub is a body with many row nodes.
// J W J^T would couple each of these nodes with every other. To avoid that, the hub's motion,
// negated, is an unknown of its own, six wide, and the matrix is
//   [ J_l W_l J_l^T + R   -J_h ]     l: the other bodies, h: hubs, M_h: mass matrices of the hubs
//   [ -J_h^T              -M_h ]
// This matrix is symmetric quasi-definite, so an LDL^T exists for every order (Vanderbei 1995).
//
// Each node has a panel of `width` rows: the node's diagonal block, then its blocks with all later
// nodes that it is coupled with. Together the panels are the matrix's upper triangle, by rows.
class EliminationPlan {
  public:
    // `can_rotate` by slot; 0 for translating bodies.
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Reserves the capacities of `other`, so that building the same structure does not allocate.
    void reserve(const EliminationPlan& other);
    // True if the plan was built from the same input.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) const;

    struct Panel {
        std::uint32_t node = 0;
        std::uint32_t width = 0;
        std::uint32_t stride = 0;        // length of a row
        std::uint32_t begin = 0;         // first value, in BlockFactor::values()
        std::uint32_t scalar = 0;        // index of the node's first unknown
        std::uint32_t blocks_begin = 0;  // index in blocks_ of the blocks with later nodes
        std::uint32_t blocks_end = 0;
        // Into updates(): one target for each pair (x, y) of its blocks, x <= y, by x, then by y.
        std::uint32_t updates = 0;
    };
    struct Block {
        std::uint32_t panel = 0;   // panel of the later node
        std::uint32_t column = 0;  // first column in the rows of the panel that contains the block
    };
    // A product of two row nodes that share a body, added to the matrix at `target`: in the rows of
    // the earlier node's panel and the columns of the later node's block.
    struct Coupling {
        std::uint32_t panel_end = 0;  // 2 * node + side
        std::uint32_t later_end = 0;
        std::uint32_t target = 0;
        std::uint32_t stride = 0;
    };
    // Location of a row node's -J in the matrix: in the hub's rows if `hub_first`, else in its
    // columns.
    struct HubCoupling {
        std::uint32_t end = 0;  // 2 * node + side
        std::uint32_t target = 0;
        std::uint32_t stride = 0;
        bool hub_first = false;
    };
    struct Hub {
        std::uint32_t slot = 0;
        std::uint32_t target = 0;  // diagonal block of the target
        std::uint32_t stride = 0;
    };
    // Location of a node's columns in an earlier panel. The column of the node's unknown m has the
    // values begin + m + i * stride, 0 <= i < rows.
    struct Appearance {
        std::uint32_t begin = 0;
        std::uint32_t rows = 0;
        std::uint32_t stride = 0;
    };

    std::span<const Panel> panels() const { return panels_; }  // panels in the order of elimination
    std::span<const Block> blocks(const Panel& panel) const {
        return std::span(blocks_).subspan(panel.blocks_begin,
                                          panel.blocks_end - panel.blocks_begin);
    }
    std::span<const std::uint32_t> updates() const { return updates_; }
    std::span<const Coupling> couplings() const { return couplings_; }
    std::span<const HubCoupling> hub_couplings() const { return hub_couplings_; }
    std::span<const Hub> hubs() const { return hubs_; }
    const Panel& panel_of(std::uint32_t node) const { return panels_[panel_of_node_[node]]; }
    std::span<const Appearance> appearances(std::uint32_t node) const {
        return std::span(appearances_)
            .subspan(appearances_begin_[node],
                     appearances_begin_[node + 1] - appearances_begin_[node]);
    }
    std::size_t value_count() const { return value_count_; }    // number of values of all panels
    std::size_t scalar_count() const { return scalar_count_; }  // number of unknowns

  private:
    static auto buffers(auto& plan) {
        return std::tie(plan.nodes_, plan.can_rotate_, plan.panels_, plan.blocks_, plan.updates_,
                        plan.couplings_, plan.hub_couplings_, plan.hubs_, plan.panel_of_node_,
                        plan.appearances_, plan.appearances_begin_, plan.ends_, plan.ends_begin_,
                        plan.rows_of_slot_, plan.hub_of_slot_, plan.merged_, plan.order_,
                        plan.eliminated_, plan.candidates_);
    }
    void find_incidence();
    void find_neighbours();
    void connect(std::uint32_t x, std::uint32_t y);
    void order_nodes();
    void eliminate(std::uint32_t node);
    bool can_eliminate(std::uint32_t node) const;
    std::uint32_t weight_of(std::uint32_t node) const;
    void lay_out();
    void find_updates();
    void find_couplings();
    void find_appearances();
    std::uint32_t column_of(const Panel& panel, std::uint32_t later) const;
    std::uint32_t width_of(std::uint32_t node) const {
        return node < nodes_.size() ? nodes_[node].width : 6;
    }

    std::vector<RowNode> nodes_;
    std::vector<std::uint8_t> can_rotate_;
    std::vector<Panel> panels_;
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> updates_;
    std::vector<Coupling> couplings_;
    std::vector<HubCoupling> hub_couplings_;
    std::vector<Hub> hubs_;
    std::vector<std::uint32_t> panel_of_node_;
    std::vector<Appearance> appearances_;
    std::vector<std::uint32_t> appearances_begin_;
    std::size_t value_count_ = 0;
    std::size_t scalar_count_ = 0;

    // Scratch of build.
    struct Candidate {
        std::uint32_t weight;
        std::uint32_t sequence;  // order in which it was offered
        std::uint32_t node;
    };
    std::vector<std::uint32_t> ends_;  // 2 * node + side, by slot
    std::vector<std::uint32_t> ends_begin_;
    std::vector<std::uint32_t> rows_of_slot_;
    std::vector<std::uint32_t> hub_of_slot_;
    std::vector<std::vector<std::uint32_t>> neighbours_;  // ascending; nodes not yet eliminated
    std::vector<std::uint32_t> merged_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint8_t> eliminated_;
    std::vector<Candidate> candidates_;  // priority queue; entries may be stale
};

}  // namespace handhold
