#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

// In which order the unknowns of an island are eliminated, and where every block of the factor
// lies: the symbolic half of a sparse LDL^T. It depends on who is tied to whom and on nothing else.
namespace handhold {

inline constexpr std::uint32_t k_widest_node = 12;  // rows: four contacts with friction
// Relative to the diagonal: smaller pivots belong to rows that repeat others beyond what alpha
// tells apart.
inline constexpr double k_smallest_pivot = 1e-14;
inline constexpr std::uint32_t k_hub_nodes = 4;  // bodies with more row nodes are hubs
inline constexpr std::uint32_t k_no_slot = std::numeric_limits<std::uint32_t>::max();

template <typename T>
void reserve_as(const std::vector<T>& other, std::vector<T>& here) {
    here.reserve(other.capacity());
}

// Rows between the same two bodies: one block of unknowns, their multipliers.
struct RowNode {
    std::uint32_t slots[2] = {k_no_slot, k_no_slot};  // of the bodies that move; a's, b's
    std::uint32_t width = 0;                          // rows
    bool is_regularised =
        false;  // all of them have so large an alpha that it can serve as their pivot
    bool is_point_link = false;  // a point held on a point by nothing soft: may lie in a strand
    bool operator==(const RowNode&) const = default;
};

// Nodes are numbered: row nodes first, in the order given, then hubs. A hub is a body with so many
// row nodes that J W J^T would tie each of them to each other; its negative motion is an unknown of
// its own instead, six wide, and the matrix is [[J_l W_l J_l^T + alpha, -J_h], [-J_h^T, -M_h]]:
// symmetric quasi-definite, so that every order of elimination exists (Vanderbei 1995).
//
// Each node has a panel: `width` rows, each from the node's own diagonal block on over the blocks
// of all later nodes that it meets: the upper triangle, by rows.
class EliminationPlan {
  public:
    // `turns` by slot: false for what only moves along (players).
    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Room for what the other has room for: a build of its structure allocates nothing.
    void reserve(const EliminationPlan& other);
    // True where it was built from the same.
    bool fits(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) const;

    struct Panel {
        std::uint32_t node = 0;
        std::uint32_t width = 0;
        std::uint32_t stride = 0;        // length of a row
        std::uint32_t begin = 0;         // of the panel, into the values
        std::uint32_t scalar = 0;        // of the node's unknowns, into vectors of unknowns
        std::uint32_t blocks_begin = 0;  // later nodes that it meets, into `blocks`
        std::uint32_t blocks_end = 0;
        std::uint32_t updates = 0;  // into `updates`: a target for each two of its blocks, (0, 0),
                                    // (0, 1) .. (1, 1), (1, 2) ..
    };
    struct Block {
        std::uint32_t panel = 0;   // of the later node
        std::uint32_t column = 0;  // in this panel's rows
    };
    // A product that is added to the matrix, of two row nodes that share a body: rows of the
    // earlier one's panel, columns of the later one's block.
    struct Coupling {
        std::uint32_t panel_end = 0;  // 2 * node + side
        std::uint32_t later_end = 0;
        std::uint32_t target = 0;
        std::uint32_t stride = 0;
    };
    // -J of a row node at a hub's rows or columns.
    struct HubCoupling {
        std::uint32_t end = 0;  // 2 * node + side
        std::uint32_t target = 0;
        std::uint32_t stride = 0;
        bool hub_first = false;
    };
    struct Hub {
        std::uint32_t slot = 0;
        std::uint32_t target = 0;  // its diagonal block
        std::uint32_t stride = 0;
    };
    // Where the column of a node's unknown m stands in an earlier panel: begin + m, `rows` times.
    struct Appearance {
        std::uint32_t begin = 0;
        std::uint32_t rows = 0;
        std::uint32_t stride = 0;
    };

    std::span<const Panel> panels() const { return panels_; }  // in the order of elimination
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
    std::size_t value_count() const { return value_count_; }    // of all panels
    std::size_t scalar_count() const { return scalar_count_; }  // unknowns

  private:
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
        std::uint32_t turn;  // when it was offered
        std::uint32_t node;
    };
    std::vector<std::uint32_t> ends_;  // 2 * node + side, by slot
    std::vector<std::uint32_t> ends_begin_;
    std::vector<std::uint32_t> rows_of_slot_;
    std::vector<std::uint32_t> hub_of_slot_;
    std::vector<std::vector<std::uint32_t>> neighbours_;  // ascending; of nodes not yet eliminated
    std::vector<std::uint32_t> merged_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint8_t> eliminated_;
    std::vector<Candidate> candidates_;  // a heap; entries may be out of date
};

}  // namespace handhold
