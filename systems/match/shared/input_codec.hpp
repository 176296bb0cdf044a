#pragma once

#include <array>

#include "systems/match/shared/bit_stream.hpp"
#include "systems/match/shared/match_input.hpp"

// Delta coding of inputs against the three ticks before, which both sides know.
namespace handhold {

// The inputs of the last ticks, the newest first.
using InputsBefore = std::array<const MatchInput*, 3>;

// Each coordinate is predicted from the last two ticks; the difference is Rice coded with a
// parameter from the size of the last difference. Precondition: the input is normalised.
void write_input(const InputsBefore& before, const MatchInput& input, BitWriter& out);
// Fails (BitReader::has_failed) for bits that write_input does not write.
MatchInput read_input(const InputsBefore& before, BitReader& in);

// Poses without meaning, which are not sent, become PackedPose{}.
MatchInput normalised(const MatchInput& input);

}  // namespace handhold
