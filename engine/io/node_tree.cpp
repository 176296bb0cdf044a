#include "engine/io/node_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace handhold {

namespace {

constexpr int k_no_parent = -1;

std::string node_place(std::size_t node) { return "/nodes/" + std::to_string(node); }

bool is_node(int index, const std::vector<FileNode>& nodes) {
    return index >= 0 && static_cast<std::size_t>(index) < nodes.size();
}

std::string describe_node_range(const std::vector<FileNode>& nodes, int found) {
    return "expected a node below " + std::to_string(nodes.size()) + ", found " +
           std::to_string(found);
}

// Sets parent_of[node] to the node's parent, or to k_no_parent for a root.
std::optional<FileError> find_parents(const std::vector<FileNode>& nodes, const std::string& file,
                                      std::vector<int>& parent_of) {
    parent_of.assign(nodes.size(), k_no_parent);
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        for (const int child : nodes[node].children) {
            if (!is_node(child, nodes)) {
                return FileError{file, node_place(node) + "/children",
                                 describe_node_range(nodes, child)};
            }
            int& parent = parent_of[static_cast<std::size_t>(child)];
            if (parent != k_no_parent) {
                return FileError{file, node_place(node) + "/children",
                                 "expected every node below one parent, found node " +
                                     std::to_string(child) + " below node " +
                                     std::to_string(parent) + " too"};
            }
            parent = static_cast<int>(node);
        }
    }
    return std::nullopt;
}

// Finds a node that is in a cycle or below one. Every node has at most one parent, so it is a node
// that cannot be reached from a root.
std::optional<FileError> find_cycle(const std::vector<FileNode>& nodes, const std::string& file,
                                    const std::vector<int>& parent_of) {
    std::vector<std::size_t> reached;
    std::vector<bool> is_reached(nodes.size(), false);
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        if (parent_of[node] == k_no_parent) {
            reached.push_back(node);
            is_reached[node] = true;
        }
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
        for (const int child : nodes[reached[i]].children) {
            reached.push_back(static_cast<std::size_t>(child));
            is_reached[static_cast<std::size_t>(child)] = true;
        }
    }
    const auto unreached = std::find(is_reached.begin(), is_reached.end(), false);
    if (unreached == is_reached.end()) {
        return std::nullopt;
    }
    return FileError{file, node_place(static_cast<std::size_t>(unreached - is_reached.begin())),
                     "expected a tree of nodes, found a cycle at or above this one"};
}

std::optional<FileError> check_roots(const std::vector<FileNode>& nodes,
                                     const std::vector<int>& parent_of,
                                     const std::vector<int>& roots, const std::string& place,
                                     const std::string& file) {
    std::vector<bool> is_listed(nodes.size(), false);
    for (const int root : roots) {
        if (!is_node(root, nodes)) {
            return FileError{file, place, describe_node_range(nodes, root)};
        }
        const std::size_t index = static_cast<std::size_t>(root);
        if (parent_of[index] != k_no_parent || is_listed[index]) {
            return FileError{
                file, place,
                "expected nodes without a parent, each once, found node " + std::to_string(root)};
        }
        is_listed[index] = true;
    }
    return std::nullopt;
}

}  // namespace

std::optional<Pose> rigid_part(const Affine& frame) {
    Mat3 axes = frame.linear;
    const double scale = cube_root(std::abs(axes.determinant()));
    if (!(scale > 1e-9) || !std::isfinite(scale) || !is_finite(frame.translation)) {
        return std::nullopt;
    }
    axes /= scale;
    const Mat3 off = axes.transpose() * axes - Mat3::Identity();
    if (!off.allFinite() || axes.determinant() < 0.0 ||
        off.cwiseAbs().maxCoeff() > 2.0 * k_max_shear) {
        return std::nullopt;
    }
    return Pose{frame.translation, Quat(axes).normalized()};
}

Result<std::vector<PlacedNode>> place_nodes(const std::vector<FileNode>& nodes,
                                            const std::optional<std::vector<int>>& roots,
                                            const std::string& roots_place,
                                            const std::string& file) {
    std::vector<int> parent_of;
    std::optional<FileError> error = find_parents(nodes, file, parent_of);
    if (!error) {
        error = find_cycle(nodes, file, parent_of);
    }
    std::vector<int> first = roots.value_or(std::vector<int>());
    if (!error && roots) {
        error = check_roots(nodes, parent_of, first, roots_place, file);
    }
    if (error) {
        return *std::move(error);
    }
    for (std::size_t node = 0; !roots && node < nodes.size(); ++node) {
        if (parent_of[node] == k_no_parent) {
            first.push_back(static_cast<int>(node));
        }
    }
    // An explicit stack: recursion over a chain of a million nodes would overflow the thread's
    // stack. `world` holds the parent's frame until the node is popped.
    std::vector<PlacedNode> open;
    for (auto root = first.rbegin(); root != first.rend(); ++root) {
        open.push_back({*root, {}});
    }
    std::vector<PlacedNode> placed;
    while (!open.empty()) {
        PlacedNode next = open.back();
        open.pop_back();
        const FileNode& node = nodes[static_cast<std::size_t>(next.node)];
        next.world.translation += next.world.linear * node.local.translation;
        next.world.linear = (next.world.linear * node.local.linear).eval();
        placed.push_back(next);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            open.push_back({*child, next.world});
        }
    }
    return placed;
}

}  // namespace handhold
