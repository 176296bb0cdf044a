#pragma once

#include <string>
#include <string_view>

#include "engine/ecs/entity.hpp"

namespace handhold {

// Layout of this build's columns, one line per field: "grab.kind enum(3)",
// "hand_history.entries[32].t_s f64". A snapshot contains the schema of the build that saved it;
// only a build with an equal schema can restore it.
const std::string& snapshot_schema();

// The first difference between two schemas: 'expected "grab.kind enum(3)", found "grab.kind
// enum(4)"'. Empty if they are equal. `found` may contain any bytes.
std::string schema_difference(std::string_view expected, std::string_view found);

// An entity in messages: "0x00000000000000a1".
std::string text_of(PersistentId id);

}  // namespace handhold
