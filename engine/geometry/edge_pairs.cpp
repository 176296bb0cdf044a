#include "engine/geometry/edge_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace handhold {
namespace {

constexpr double k_same_angle_rad = 1e-6;

// A half-edge of a non-manifold edge, with the angle of its triangle about the edge.
struct FaceLeaf {
    // In [0, 2 pi), from the first triangle; counter-clockwise if the edge points at the viewer.
    double angle_rad = 0.0;
    const HalfEdge* half = nullptr;
};

std::vector<FaceLeaf> sorted_about_edge(std::span<const HalfEdge> edge,
                                        std::span<const Vec3> positions) {
    const Vec3 origin = positions[edge[0].low];
    const Vec3 along = (positions[edge[0].high] - origin).normalized();
    const auto off_edge = [&](const HalfEdge& half) -> Vec3 {
        const Vec3 offset = positions[half.third] - origin;
        return offset - offset.dot(along) * along;
    };
    const Vec3 x = off_edge(edge[0]).normalized();
    const Vec3 y = along.cross(x);
    std::vector<FaceLeaf> leaves;
    for (const HalfEdge& half : edge) {
        const Vec3 side = off_edge(half);
        double angle = arc_tangent2(side.dot(y), side.dot(x));
        angle += angle < -k_same_angle_rad ? 2.0 * k_pi : 0.0;
        leaves.push_back({std::max(angle, 0.0), &half});
    }
    std::sort(leaves.begin(), leaves.end(), [](const FaceLeaf& a, const FaceLeaf& b) {
        return std::tuple(a.angle_rad, a.half->id) < std::tuple(b.angle_rad, b.half->id);
    });
    // Triangles at nearly the same angle count as one angle; among them, backward half-edges come
    // first.
    for (std::size_t first = 0; first < leaves.size();) {
        std::size_t last = first + 1;
        while (last < leaves.size() &&
               leaves[last].angle_rad - leaves[last - 1].angle_rad < k_same_angle_rad) {
            ++last;
        }
        const auto at = [&](std::size_t i) {
            return leaves.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::sort(at(first), at(last), [](const FaceLeaf& a, const FaceLeaf& b) {
            return std::tuple(a.half->forward, a.half->id) <
                   std::tuple(b.half->forward, b.half->id);
        });
        first = last;
    }
    return leaves;
}

// The outer side of a forward half-edge's triangle faces greater angles, that of a backward
// half-edge's triangle smaller angles. So forward and backward half-edges are matched like opening
// and closing brackets. The second round matches pairs across angle 0. Removes the matched
// half-edges from `leaves`.
void pair_opposed(std::vector<FaceLeaf>& leaves, std::vector<EdgePair>& pairs) {
    std::vector<std::size_t> open;
    std::vector<bool> taken(leaves.size(), false);
    for (std::size_t step = 0; step < 2 * leaves.size(); ++step) {
        const std::size_t i = step % leaves.size();
        if (taken[i]) {
            continue;
        }
        if (!leaves[i].half->forward && !open.empty()) {
            pairs.push_back({leaves[open.back()].half->id, leaves[i].half->id, true});
            taken[open.back()] = taken[i] = true;
            open.pop_back();
        } else if (leaves[i].half->forward && step < leaves.size()) {
            open.push_back(i);
        }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (!taken[i]) {
            leaves[kept++] = leaves[i];
        }
    }
    leaves.resize(kept);
}

// Pairs the flattest first: those with a dihedral angle nearest to pi. Removes them from `leaves`.
void pair_flattest(std::vector<FaceLeaf>& leaves, std::vector<EdgePair>& pairs) {
    // Largest number of half-edges at one edge for which all pairs are compared. More are paired
    // arbitrarily; real surfaces have fewer.
    constexpr std::size_t k_max_exhaustive = 32;
    while (leaves.size() >= 2) {
        std::size_t best_a = 0;
        std::size_t best_b = 1;
        double min_fold_rad = 2.0 * k_pi;
        for (std::size_t a = 0; leaves.size() <= k_max_exhaustive && a < leaves.size(); ++a) {
            for (std::size_t b = a + 1; b < leaves.size(); ++b) {
                const double fold_rad = std::abs(leaves[b].angle_rad - leaves[a].angle_rad - k_pi);
                if (fold_rad < min_fold_rad) {
                    min_fold_rad = fold_rad;
                    best_a = a;
                    best_b = b;
                }
            }
        }
        pairs.push_back({leaves[best_a].half->id, leaves[best_b].half->id, false});
        leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(best_b));
        leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(best_a));
    }
}

}  // namespace

std::vector<HalfEdge> sorted_half_edges(std::size_t vertex_count,
                                        std::span<const std::array<std::uint32_t, 3>> triangles) {
    // Bucket sort by low vertex, then a sort of each small bucket.
    std::vector<std::uint32_t> ends(vertex_count + 1, 0);
    const auto low_of = [](const std::array<std::uint32_t, 3>& t, std::size_t i) {
        return std::min(t[i], t[(i + 1) % 3]);
    };
    for (const auto& triangle : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++ends[low_of(triangle, i) + 1];
        }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        ends[v + 1] += ends[v];
    }
    std::vector<HalfEdge> sorted(3 * triangles.size());
    std::vector<std::uint32_t> next(ends.begin(), ends.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangles[t][i];
            const std::uint32_t to = triangles[t][(i + 1) % 3];
            sorted[next[std::min(from, to)]++] = {std::min(from, to), std::max(from, to),
                                                  triangles[t][(i + 2) % 3],
                                                  static_cast<std::uint32_t>(3 * t + i), from < to};
        }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        std::sort(sorted.begin() + ends[v], sorted.begin() + ends[v + 1],
                  [](const HalfEdge& a, const HalfEdge& b) {
                      return std::tie(a.high, a.third, a.id) < std::tie(b.high, b.third, b.id);
                  });
    }
    return sorted;
}

void pair_half_edges(std::span<const HalfEdge> edge, std::span<const Vec3> positions,
                     std::vector<EdgePair>& pairs) {
    if (edge.size() < 2) {
        return;
    }
    if (edge.size() == 2) {
        pairs.push_back({edge[0].id, edge[1].id, edge[0].forward != edge[1].forward});
        return;
    }
    std::vector<FaceLeaf> leaves = sorted_about_edge(edge, positions);
    pair_opposed(leaves, pairs);
    pair_flattest(leaves, pairs);
}

}  // namespace handhold
