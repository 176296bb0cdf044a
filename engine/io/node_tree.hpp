#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/io/result.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A node of a scene file, as it stands there: nothing about the indices is known.
struct FileNode {
    Affine local;  // into the parent's frame
    std::vector<int> children;
};

// The rigid part of a frame that is turned, moved and evenly scaled; nothing where it is anything
// else. Axes may differ in length and lean by 2 %: what float files leave of a rotation.
std::optional<Pose> rigid_part(const Affine& frame);

struct PlacedNode {
    int node = 0;
    Affine world;  // into the scene's frame
};

// The nodes that hang from `roots` (without a value: from every node that has no parent), parents
// before children and siblings in order. Refused, with a JSON pointer of glTF: an index that is no
// node, a node with two parents, a cycle anywhere, a root that has a parent or is listed twice.
// `roots_place` is the pointer of the list of roots.
Result<std::vector<PlacedNode>> place_nodes(const std::vector<FileNode>& nodes,
                                            const std::optional<std::vector<int>>& roots,
                                            const std::string& roots_place,
                                            const std::string& file);

}  // namespace handhold
