#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/bounds.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// What the last pass over all pairs found, so that a pair need not be met again of which nothing
// moved since, as most within one frame, or whose free body stays where the other has nothing. A
// cache: what it gives back is, bit for bit, what a pair gives that is met afresh. Pairs are asked
// for by rising (id of a, id of b).
class PairCache {
  public:
    // A collider and when it last changed, in changes of any.
    struct Seen {
        std::uint64_t id = 0;
        std::uint64_t stamp = 0;
    };
    // What a pair has: its contacts, and a box in which b has nothing for as long as it does not
    // change, where one is known.
    struct Known {
        std::span<const ContactPoint> contacts;
        std::optional<Bounds> clear_ws;
    };

    void begin(const ContactLimits& limits);
    // Nothing where the pair has to be met; else good until the next pass begins. `reach_ws`: a's
    // whole way and the margin about it.
    std::optional<Known> recall(const Seen& a, const Seen& b, const Bounds& reach_ws);
    // What the pair has in this pass, for the next one.
    void note(const Seen& a, const Seen& b, const Known& known);

  private:
    struct Pair {
        Seen a;
        Seen b;
        std::uint32_t first = 0;  // into the contacts found in its pass
        std::uint32_t count = 0;
        std::optional<Bounds> clear_ws;
    };
    struct Pass {
        std::vector<Pair> pairs;
        std::vector<ContactPoint> contacts;
        void clear();
    };

    Pass now_;
    Pass last_;
    std::size_t next_pair_ = 0;  // of last_, not yet passed
    ContactLimits limits_;
};

}  // namespace handhold
