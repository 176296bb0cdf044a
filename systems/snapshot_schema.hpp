#pragma once

#include <string>
#include <string_view>

namespace handhold {

// What the columns of this build look like, one line a field: "grab.kind enum(3)",
// "hand_history.entries[32].t_s f64". A snapshot holds its own; only equal ones can be restored.
const std::string& snapshot_schema();

// Where two schemas part first: 'expected "grab.kind enum(3)", found "grab.kind enum(4)"'. Empty
// for equal ones. What was found may be any bytes.
std::string schema_difference(std::string_view expected, std::string_view found);

}  // namespace handhold
