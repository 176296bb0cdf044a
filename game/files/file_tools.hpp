#pragma once

// The engine's tools for files, collected for code of the game that otherwise uses only the
// library's public interface: results with errors that name file and place, text files, CSV, JSON,
// and names that are safe to print.
#include <handhold/handhold.hpp>

#include "engine/core/printable.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/csv.hpp"
#include "engine/io/json.hpp"

namespace handhold {

// Reads a pose from an object with the optional members "position_m" and "rotation_xyzw" and no
// others. Coordinates must be in [-limit_m, limit_m]. A missing object gives the identity.
hh::Pose read_pose(const JsonValue& value, double limit_m);

}  // namespace handhold
