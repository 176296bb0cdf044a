#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/triangle_bvh.hpp"
#include "engine/math/float4.hpp"

namespace handhold {

// Builds a TriangleBvh top-down. Each binary split is the cheapest of k_bins planes along each axis
// by the surface area heuristic. Binary nodes are then collapsed to nodes with four children,
// largest area first. The order of a set's triangles has no effect, so the tree is the same on
// every compiler and library.
class BvhBuilder {
  public:
    BvhBuilder(TriangleBvh& bvh, std::span<const Vec3> positions,
               std::span<const std::array<std::uint32_t, 3>> triangles);
    void build();

  private:
    struct Box {
        Float4 low;  // x, y, z; the fourth lane is no part of the box
        Float4 high;
        static Box none();
        void join(const Box& other);
        double half_area() const;
        Float4 middle() const { return splat4(0.5F) * (low + high); }
    };
    // The triangle's number is stored in the fourth lane of `box.low`: 32 bytes instead of 48.
    struct Item {
        Box box;
        std::uint32_t triangle() const {
            return std::bit_cast<std::array<std::uint32_t, 4>>(box.low)[3];
        }
        void set_triangle(std::uint32_t number) { box.low[3] = std::bit_cast<float>(number); }
    };
    // A binary node. The children of an inner node are adjacent.
    struct Pair {
        Box box;
        std::uint32_t first = 0;  // inner: first child; leaf: first item, later first slot
        std::uint32_t count = 0;  // leaf: number of items; 0: inner
    };
    struct Work {
        std::uint32_t pair;
        std::uint32_t first;
        std::uint32_t last;
        std::uint32_t depth;
    };
    struct Split {
        std::size_t axis = 0;
        std::uint32_t bin = 0;  // first bin of the upper side
        // Sum over both sides of: groups of four triangles times half the box's area.
        double cost = 0.0;
        bool found = false;
    };
    static constexpr std::size_t k_bins = 16;

    void gather();
    void divide();
    struct Bins {
        std::array<Box, k_bins> boxes;
        std::array<std::uint32_t, k_bins> counts;
    };
    // The bin of the item's middle along each axis.
    static Int4 bins_of(const Item& item, const Box& middles);
    Split best_split(const Work& work, const Box& middles) const;
    static Split best_split_along(std::size_t axis, const Bins& bins, std::uint32_t all);
    std::uint32_t part(const Work& work, const Split& split, const Box& middles);
    void make_leaf(const Work& work);
    void fill_leaves();
    std::array<std::uint32_t, 3> copy_corners(std::uint32_t triangle);
    void add_four(std::uint32_t first_slot);
    void make_nodes();
    std::vector<std::uint32_t> four_below(std::uint32_t pair) const;

    TriangleBvh& bvh_;
    std::span<const Vec3> positions_;
    std::span<const std::array<std::uint32_t, 3>> triangles_;
    float padding_ = 0.0F;
    std::vector<Item> items_;
    std::vector<Pair> pairs_;            // root first
    std::vector<std::uint32_t> copied_;  // index in the tree's positions, one per position
};

}  // namespace handhold
