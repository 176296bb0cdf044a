#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/match/match_messages.hpp"
#include "systems/match/shared/hash_marks.hpp"
#include "systems/match/shared/input_history.hpp"

// The inputs of all slots in confirmed ticks: what spectators get, and what a recording keeps. One
// packet goes on where another ends; inputs that the server filled are one bit.
namespace handhold {

// No tick of 16 players needs more.
inline constexpr std::size_t k_most_confirmed_bytes = 8192;
// Ticks of a packet.
inline constexpr MatchTick k_most_confirmed_ticks = 128;
// Histories keep the inputs that the first tick of a packet is encoded against for so long.
inline constexpr MatchTick k_oldest_confirmed =
    InputHistory::k_capacity - InputHistory::k_looks_back;

// True if the ticks after `after`, up to `confirmed` if that is later, can be written.
bool can_write_confirmed(std::span<const InputHistory> histories, MatchTick after,
                         MatchTick confirmed);
// Writes the ticks after `after` up to `until`, or fewer: as many as fit, k_most_confirmed_ticks at
// most. `until` gets the last tick written. Returns the size. Preconditions: can_write_confirmed;
// k_most_confirmed_bytes or more.
std::size_t write_confirmed(std::span<const InputHistory> histories, const HashMarks& hashes,
                            MatchTick after, MatchTick& until, std::span<std::byte> bytes);

// Adds the ticks of a packet that the histories do not have, and the hashes in it. All histories
// have the same final_until(). Refused packets change nothing: gap, if it begins after that tick or
// long before; window, if it ends so far after `now` that the inputs of the tick after that would
// be forgotten.
MatchRefusal read_confirmed(std::span<const std::byte> bytes, MatchTick now,
                            std::span<InputHistory> histories, HashMarks& hashes);

}  // namespace handhold
