#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/io/result.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A node as the scene file has it. Its children are unchecked indices.
struct FileNode {
    Affine local;  // into the parent's frame
    std::vector<int> children;
};

// The rotation and translation of a frame. Nothing if the frame is scaled unevenly, sheared or
// mirrored. Axes may differ by 2 % in length and from right angles: files store floats.
std::optional<Pose> rigid_part(const Affine& frame);

struct PlacedNode {
    int node = 0;
    Affine world;  // into the scene's frame
};

// The nodes at and below `roots`, parents before children and siblings in the file's order. Without
// a value, the roots are all nodes without a parent. Refused, with a JSON pointer of glTF: an index
// out of range, a node with two parents, a cycle anywhere, a root that has a parent or is listed
// twice. `roots_place` is the pointer of the list of roots.
Result<std::vector<PlacedNode>> place_nodes(const std::vector<FileNode>& nodes,
                                            const std::optional<std::vector<int>>& roots,
                                            const std::string& roots_place,
                                            const std::string& file);

}  // namespace handhold
