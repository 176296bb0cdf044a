#pragma once

#include <optional>
#include <string>

#include "components/world.hpp"
#include "engine/geometry/shape_library.hpp"

namespace handhold {

// A violation of what step_frame relies on.
struct WorldBreach {
    std::string place;     // e.g. "hand_owner[0x5d...1].player"
    std::string expected;  // e.g. "expected a player"
};

// Returns the first violation of the rules between elements (docs/reference/snapshot_format.md);
// nullopt if step_frame can run. Each field must have been validated by itself. Worlds made by
// add_body, add_joint, add_player and frames have no violation. A player's collider may have
// k_no_shape: its head is made afterwards (MissingHeads).
std::optional<WorldBreach> find_breach(const World& world, const ShapeLibrary& shapes);

}  // namespace handhold
