#pragma once

#include <map>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

// The humanoid table of VRM files. Source: VRM 0.0 (extension VRM) and VRM 1.0 (VRMC_vrm).
namespace handhold {

// Maps the name of a VRM bone ("leftUpperArm") to the name of its node. Empty if the file has no
// such table. Leaves out nodes without a name and names that several nodes have. `bytes` are those
// of a .glb, .vrm or .gltf; `file` is used in messages.
//
// Errors, with the JSON pointer of the cause: bytes that are not glTF; a table with members of
// other types, or with nodes that do not exist.
Result<std::map<std::string, std::string>> parse_vrm_humanoid(std::string_view bytes,
                                                              const std::string& file);

}  // namespace handhold
