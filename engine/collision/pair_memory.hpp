#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/collision_world.hpp"

namespace handhold {

// What the last pass over all pairs found, so that a pair of which nothing moved since is not met
// again: within one frame most pairs. A cache: what it gives back is, bit for bit, what a pair
// gives that is met afresh. Pairs are asked for by rising (id of a, id of b).
class PairMemory {
  public:
    // Begins a pass. Then every collider, by rising id, before the first pair.
    void begin(const ContactLimits& limits);
    void add(const ColliderProxy& proxy);

    // a and b: colliders by their place in the order of add. Nothing where the pair has to be met;
    // else its contacts, good until the next pass begins.
    std::optional<std::span<const ContactPoint>> recall(std::size_t a, std::size_t b);
    // What the pair has in this pass, for the next one.
    void note(std::size_t a, std::size_t b, std::span<const ContactPoint> found);

  private:
    // A collider and when it last changed, in changes of any.
    struct Seen {
        ColliderProxy proxy;
        std::uint64_t stamp = 0;
    };
    struct Pair {
        std::uint64_t id_a = 0;
        std::uint64_t id_b = 0;
        std::uint64_t stamp_a = 0;
        std::uint64_t stamp_b = 0;
        std::uint32_t first = 0;  // into the contacts found in its pass
        std::uint32_t count = 0;
    };
    struct Pass {
        std::vector<Seen> colliders;
        std::vector<Pair> pairs;
        std::vector<ContactPoint> contacts;
        void clear();
    };

    Pass now_;
    Pass last_;
    std::size_t next_collider_ = 0;  // of last_, not yet passed
    std::size_t next_pair_ = 0;
    std::uint64_t changes_ = 0;
    ContactLimits limits_;
};

}  // namespace handhold
