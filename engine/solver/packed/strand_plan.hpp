// Solver, packed: cuts the long chains of an island into strand packs. Terms and a diagram are in
// triad_system.hpp.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// Strands and rest of an island's nodes. A run is a sequence of links each of which shares a body
// with the next. Each long run is cut by separators into four strands of equal length (nested
// dissection). Nothing couples two strands except the separators, so all four are eliminated side
// by side. The rest is the separators and every node that is in no run.
//
// A strand has `length` links and length + 1 bodies, counted in rows: link k connects the bodies of
// rows k and k + 1. Its first and its last body may each have one node of the rest. Towards the
// rest, a strand counts as one body: slot `slot_count() + 4 * strand pack + lane` of `rest_nodes`.
class StrandPlan {
  public:
    using Lanes = std::array<std::uint32_t, 4>;

    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Reserves the other plan's capacities, so that a build of its structure does not allocate.
    void reserve(const StrandPlan& other);

    // Four strands, one per lane.
    struct StrandPack {
        std::uint32_t length = 0;  // links per strand
        std::uint32_t row = 0;     // first of its length + 1 rows, into `bodies`
        std::uint32_t links = 0;   // first of its `length` steps, into `links`
        // The rest's end at the first body, k_no_slot if there is none: 2 * (index in `rest`) +
        // side.
        Lanes before{};
        Lanes after{};  // the same at the last body
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    std::size_t row_count() const { return bodies_.size(); }
    // By row: slots. k_no_slot if the strand starts at an immovable body.
    std::span<const Lanes> bodies() const { return bodies_; }
    // By strand pack and step: 2 * node + the side at row k.
    std::span<const Lanes> links() const { return links_; }

    std::span<const std::uint32_t> rest() const { return rest_; }  // nodes, ascending
    // Index of a node in `rest`; k_no_slot for a strand's.
    std::span<const std::uint32_t> places() const { return places_; }
    std::span<const RowNode> rest_nodes() const { return rest_nodes_; }
    std::span<const std::uint8_t> rest_can_rotate() const { return rest_can_rotate_; }
    std::span<const std::uint32_t> rest_slots() const { return rest_slots_; }  // ascending
    std::size_t slot_count() const { return slot_count_; }

  private:
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
    std::vector<std::array<std::uint32_t, 2>> ends_;  // by slot: the first two ends at it
    std::vector<std::uint32_t> uses_;                 // by slot
    std::vector<std::uint8_t> is_open_;               // by node: a link that is in no run yet
    std::vector<std::uint32_t> run_;                  // 2 * node + the side at which the run enters
    std::vector<std::uint32_t> strand_of_slot_;
};

}  // namespace handhold
