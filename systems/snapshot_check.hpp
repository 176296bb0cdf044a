#pragma once

#include <optional>
#include <string>

#include "components/world.hpp"
#include "engine/collision/shape_library.hpp"

namespace handhold {

// Where a world breaks what step_frame relies on.
struct WorldBreach {
    std::string place;     // "hand_owner[0x5d...1].player"
    std::string expected;  // and what was found
};

// The first breach of the rules between rows (docs/reference/snapshot_format.md), for a world whose
// fields are each by itself as they should be; none where step_frame can run. Worlds made by
// add_body, add_player and frames have none.
std::optional<WorldBreach> find_breach(const World& world, const ShapeLibrary& shapes);

// "0x00000000000000a1": entities in messages.
std::string text_of(PersistentId id);

}  // namespace handhold
