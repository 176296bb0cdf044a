#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

// Builds a TriangleBvh top-down. Each binary split is the cheapest of k_bins planes along each axis
// by the surface area heuristic. Binary nodes are then collapsed to four children, largest area
// first. The order of triangles within a set has no effect, so the tree is the same on every
// compiler and library.
class BvhBuilder {
  public:
    BvhBuilder(TriangleBvh& bvh, std::span<const Vec3> positions,
               std::span<const std::array<std::uint32_t, 3>> triangles);
    void build();

  private:
    struct Box {
        std::array<float, 3> low;
        std::array<float, 3> high;
        static Box none();
        void join(const Box& other);
        double half_area() const;
        float middle(std::size_t axis) const { return 0.5F * (low[axis] + high[axis]); }
    };
    struct Item {
        Box box;
        std::uint32_t triangle;
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
        double cost = 0.0;      // number of fours times half the box area, summed
        bool found = false;
    };
    static constexpr std::size_t k_bins = 16;

    void gather();
    void divide();
    static std::uint32_t bin_of(const Item& item, const Box& middles, std::size_t axis);
    Split best_split(const Work& work, const Box& middles) const;
    Split best_split_along(std::size_t axis, const Work& work, const Box& middles) const;
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
    std::vector<std::uint32_t> copied_;  // per position, its index in the tree
};

}  // namespace handhold
