#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/bounds.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// Caches the results of the last pass over all pairs. A pair's result is reused if neither collider
// changed (common between the passes of one frame), or if a is still inside a box that b does not
// reach into. Reused results are bitwise equal to recomputed ones. Pairs must be queried in
// ascending (id of a, id of b).
class PairCache {
  public:
    // A collider and the change counter at its last change.
    struct Version {
        std::uint64_t id = 0;
        std::uint64_t stamp = 0;
    };
    // A pair's contacts, and, if known, a box that b does not reach into while b is unchanged.
    struct Result {
        std::span<const ContactPoint> contacts;
        std::optional<Bounds> clear_ws;
    };

    void begin(const ContactLimits& limits);
    // The cached result, valid until the next begin(); nullopt if the pair must be recomputed.
    // `reach_ws`: a's swept bounds plus margin.
    std::optional<Result> recall(const Version& a, const Version& b, const Bounds& reach_ws);
    // Records the pair's result for the next pass.
    void record(const Version& a, const Version& b, const Result& result);

  private:
    struct Pair {
        Version a;
        Version b;
        std::uint32_t first = 0;  // index into Pass::contacts
        std::uint32_t count = 0;
        std::optional<Bounds> clear_ws;
    };
    struct Pass {
        std::vector<Pair> pairs;
        std::vector<ContactPoint> contacts;
        void clear();
    };

    Pass current_;
    Pass last_;
    std::size_t next_pair_ = 0;  // cursor into last_.pairs
    ContactLimits limits_;
};

}  // namespace handhold
