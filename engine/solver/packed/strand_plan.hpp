// Solver, packed: cuts the long chains of an island into strand packs. Terms and a diagram are in
// triad_system.hpp.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// Splits an island's nodes (here: triads, see triad_system.hpp) into strands and the rest. A link
// is a point triad between two bodies that each have at most one other triad. A run is a sequence
// of links; consecutive links share a body. Three separators, of one or two links each, cut a long
// run into four strands of equal length (nested dissection). Strands are coupled only through
// separators, so all four are eliminated side by side. The rest is all nodes that are in no strand.
//
// A strand has `length` links and length + 1 bodies; its link k connects its bodies k and k + 1.
// Row k of a strand pack holds body k of each of its four strands. The first and the last body of a
// strand may each have one node of the rest. In `rest_nodes`, a strand counts as one body, with the
// slot `slot_count() + 4 * strand pack + lane`.
class StrandPlan {
  public:
    using Lanes = std::array<std::uint32_t, 4>;

    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Reserves the capacities of `other`, so that building the same structure does not allocate.
    void reserve(const StrandPlan& other);

    // Four strands of equal length, one per lane.
    struct StrandPack {
        std::uint32_t length = 0;  // links per strand
        std::uint32_t row = 0;     // first of its length + 1 rows, in bodies()
        std::uint32_t links = 0;   // first of its `length` steps, in links()
        // By lane: the node of the rest at the strand's first body, as 2 * (index in rest()) +
        // side; k_no_slot if there is none.
        Lanes before{};
        Lanes after{};  // same, at the last body
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    std::size_t row_count() const { return bodies_.size(); }
    // By row: slots of its four bodies. k_no_slot if a strand starts at an immovable body.
    std::span<const Lanes> bodies() const { return bodies_; }
    // For each step k of each strand pack, by lane: 2 * (the link's node) + its side at row k.
    std::span<const Lanes> links() const { return links_; }

    std::span<const std::uint32_t> rest() const { return rest_; }  // node numbers, ascending
    // By node: its index in rest(); k_no_slot if it is in a strand.
    std::span<const std::uint32_t> places() const { return places_; }
    std::span<const RowNode> rest_nodes() const { return rest_nodes_; }
    std::span<const std::uint8_t> rest_can_rotate() const { return rest_can_rotate_; }
    // Slots of the bodies in no strand, ascending.
    std::span<const std::uint32_t> rest_slots() const { return rest_slots_; }
    std::size_t slot_count() const { return slot_count_; }

  private:
    static auto buffers(auto& plan) {
        return std::tie(plan.strand_packs_, plan.bodies_, plan.links_, plan.rest_, plan.places_,
                        plan.rest_nodes_, plan.rest_can_rotate_, plan.rest_slots_, plan.ends_,
                        plan.uses_, plan.is_open_, plan.run_, plan.strand_of_slot_);
    }
    void find_ends(std::span<const RowNode> nodes);
    std::uint32_t beyond(std::span<const RowNode> nodes, std::uint32_t end) const;
    void find_links(std::span<const RowNode> nodes);
    void follow(std::span<const RowNode> nodes, std::uint32_t from);
    void cut(std::span<const RowNode> nodes);
    void add_strand(std::span<const RowNode> nodes, std::span<const std::uint32_t> ends,
                    std::uint32_t lane);
    void lay_out_rest(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);

    std::vector<StrandPack> strand_packs_;
    std::vector<Lanes> bodies_;
    std::vector<Lanes> links_;
    std::vector<std::uint32_t> rest_;
    std::vector<std::uint32_t> places_;
    std::vector<RowNode> rest_nodes_;
    std::vector<std::uint8_t> rest_can_rotate_;
    std::vector<std::uint32_t> rest_slots_;
    std::size_t slot_count_ = 0;

    // Scratch of build.
    // by slot: its first two nodes, as 2 * node + side
    std::vector<std::array<std::uint32_t, 2>> ends_;
    std::vector<std::uint32_t> uses_;    // number of nodes of each slot
    std::vector<std::uint8_t> is_open_;  // one per node; 1: a link in no run yet
    std::vector<std::uint32_t> run_;     // the current run: 2 * node + side nearer its start
    std::vector<std::uint32_t> strand_of_slot_;
};

}  // namespace handhold
