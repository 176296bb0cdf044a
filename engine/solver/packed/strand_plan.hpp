#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// The long runs of links in an island, each cut into four strands of one length by separators:
// links that each share a body with the next one and are eliminated one after the other, four
// side by side, with nothing between strands but the separators (nested dissection). What is left
// is the rest: the separators, and all that is no run.
//
// A strand has `length` links and one body more, counted in rows: link k lies between the bodies of
// rows k and k + 1. At its first and at its last body there may be one node of the rest each. To
// the rest, a strand is one body: slot `slot_count() + 4 * braid + lane` of `rest_nodes`.
class StrandPlan {
  public:
    using Lanes = std::array<std::uint32_t, 4>;

    void build(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate);
    // Room for what the other has room for: a build of its structure allocates nothing.
    void reserve(const StrandPlan& other);

    // Four strands.
    struct StrandPack {
        std::uint32_t length = 0;  // links of each
        std::uint32_t row = 0;     // the first of length + 1, into `bodies`
        std::uint32_t links = 0;   // the first of `length`, into `links`
        Lanes before{};  // the rest's end at the first body, k_no_slot where there is none: 2 *
                         // (its place in `rest`) + side
        Lanes after{};   // and at the last body
    };
    std::span<const StrandPack> strand_packs() const { return strand_packs_; }
    std::size_t row_count() const { return bodies_.size(); }
    // By row: slots. k_no_slot where the strand begins at what nothing moves.
    std::span<const Lanes> bodies() const { return bodies_; }
    // By braid and link: 2 * node + the side at the row before.
    std::span<const Lanes> links() const { return links_; }

    std::span<const std::uint32_t> rest() const { return rest_; }  // nodes, ascending
    // The place of a node in `rest`; k_no_slot for a strand's.
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
    std::vector<std::array<std::uint32_t, 2>> ends_;  // by slot: the first two of its ends
    std::vector<std::uint32_t> uses_;                 // by slot
    std::vector<std::uint8_t> is_open_;               // by node: a link that no run has yet
    std::vector<std::uint32_t> run_;  // 2 * node + the side that the run comes in by
    std::vector<std::uint32_t> strand_of_slot_;
};

}  // namespace handhold
