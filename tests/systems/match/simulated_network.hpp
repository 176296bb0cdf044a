#pragma once

#include <cstdint>
#include <cstdlib>

#include "tests/random.hpp"
#include "tools/lab/match_network.hpp"

namespace handhold::match_test {

using lab::NetworkTraits;
using lab::SimulatedNetwork;

// The seed of a test's networks and players. HANDHOLD_MATCH_SEED=N in the environment varies all of
// them, to run the tests over other networks.
inline std::uint64_t seed_of(std::uint64_t test) {
    const char* const text = std::getenv("HANDHOLD_MATCH_SEED");
    const std::uint64_t varied = text != nullptr ? std::strtoull(text, nullptr, 10) : 0;
    return test + 1000 * varied;
}

}  // namespace handhold::match_test
