#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "systems/match/match_world.hpp"
#include "systems/match/shared/input_history.hpp"
#include "systems/snapshot/snapshot.hpp"

// What a player who joins late gets over a reliable stream: a snapshot of the world after a
// confirmed tick, and the final inputs of all slots: the last ones before the tick, and those after
// it that the server has received, also of the joining player's own slot.
namespace handhold {

void write_join_state(const MatchWorld& match, const SnapshotAssets& assets,
                      std::span<const InputHistory> histories, std::uint8_t state_epoch,
                      std::vector<std::byte>& bytes);
// Tolerates any bytes. On error nothing changes. `state_epoch`: ClientPacket::state_epoch from now
// on.
[[nodiscard]] std::optional<FileError> read_join_state(
    std::span<const std::byte> bytes, const SnapshotAssets& assets, const MissingHeads& heads,
    const MatchWorld& match, std::span<InputHistory> histories, std::uint8_t& state_epoch);

}  // namespace handhold
