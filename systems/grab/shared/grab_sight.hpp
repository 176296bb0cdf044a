#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/grab/shared/grab_search.hpp"
#include "systems/grab/shared/hand_sight.hpp"

// What the hands of a GrabSearch see.
namespace handhold {

// Bodies that are no obstacle to a hand: its player's head, and what the player's hands held at the
// start of the frame.
struct SightSkips {
    std::array<std::uint64_t, 1 + k_hand_count> ids{};
    std::size_t count = 0;
    std::span<const std::uint64_t> view() const { return std::span(ids).first(count); }
};
SightSkips sight_skips(const GrabSearch& io, Entity hand);

// Sight lines of a hand with its palm at `palm_ws`. A hand whose HandSight is unknown counts as
// outside of walls where it is now. The result refers to `skips`.
SightLines sight_lines(const GrabSearch& io, Entity hand, const Vec3& palm_ws,
                       const SightSkips& skips, const HeadTuning& tuning);

// Advances HandSight of all hands to the start of the frame.
void update_sights(const GrabSearch& io, const Tuning& tuning);

}  // namespace handhold
