#pragma once

// The engine's tools for files, for code of the game that otherwise knows the library's interface
// only: results with errors that name file and place, text files, CSV, JSON, and names that are
// safe to print.
#include <handhold/handhold.hpp>

#include "engine/core/printable.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/csv.hpp"
#include "engine/io/json.hpp"

namespace handhold {

// Reads members "position_m" and "rotation_xyzw" of an object, which are optional, and no others.
// Each coordinate within `limit_m`. A missing object: the origin.
hh::Pose read_pose(const JsonValue& value, double limit_m);

}  // namespace handhold
