#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A node as the scene file has it. The indices of its children are not checked.
struct FileNode {
    Affine local;  // transform into the parent's frame
    std::vector<int> children;
};

inline constexpr double k_max_shear = 0.02;

// The rotation and translation of a frame. nullopt if the frame is scaled unevenly, sheared or
// mirrored. k_max_shear is the tolerance for the axes' lengths and right angles, because files
// store floats.
std::optional<Pose> rigid_part(const Affine& frame);

struct PlacedNode {
    int node = 0;
    Affine world;  // transform into the scene's frame
};

// The nodes at and below `roots`, parents before children and siblings in the file's order. If
// `roots` has no value, the roots are all nodes without a parent. Errors, with a glTF JSON pointer:
// an index out of range, a node with two parents, a cycle anywhere, a root that has a parent or is
// listed twice. `roots_place` is the pointer of the list of roots.
Result<std::vector<PlacedNode>> place_nodes(const std::vector<FileNode>& nodes,
                                            const std::optional<std::vector<int>>& roots,
                                            const std::string& roots_place,
                                            const std::string& file);

}  // namespace handhold
