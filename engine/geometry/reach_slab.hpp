#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// Which triangles one chain may come to: told in floats, four triangles at a time.
namespace handhold {

// An upright box in disc space.
struct ReachBox {
    Vec2 low = Vec2::Constant(-std::numeric_limits<double>::infinity());
    Vec2 high = Vec2::Constant(std::numeric_limits<double>::infinity());
};

// Where a chain's links can be: a disc with a thickness, and of that what is in a box of one of
// the links.
struct ChainReach {
    Pose base;                // the first hinge: links along -Z at angle 0, turning towards -Y
    double radius_m = 0;      // about the hinge, in the plane
    double half_width_m = 0;  // across the plane
    std::array<ReachBox, k_max_disc_links> boxes = {};  // in the plane
    std::uint32_t box_count = 0;                        // 0: all of the disc
};

// Four triangles by axis of disc space (_ds, disc_contact.hpp; the third across the plane): what
// holds each of them, with room to spare for what floats round off.
struct ReachedTriangles4 {
    std::array<Float4, 3> low = {};
    std::array<Float4, 3> high = {};
    // Where a triangle's plane meets the chain's own: line[0] x + line[1] y = line[2]. All 0 where
    // its normal is not known.
    std::array<Float4, 3> line = {};
    Corners4 corner = {};
};

// By box of the reach, or the only one: which of four triangles may be in reach there.
using ReachMasks4 = std::array<Int4, k_max_disc_links>;

// A chain's reach in the frame of a tree of triangles.
class ReachSlab {
  public:
    // `base` is the reach's in the mesh's frame.
    ReachSlab(const ChainReach& reach, const Pose& base, const TriangleBvh& bvh);

    const OrientedBox& box() const { return box_; }  // about the tree's origin, around all of it

    // Bounds in the plane are clamped to twice the reach's radius: what is farther out needs no
    // place of its own, and a float would not know it well.
    ReachedTriangles4 bounds_of(const Triangles4& four, ReachMasks4& is_near) const;

    double rounding_margin_m() const { return rounding_margin_m_; }  // more than floats round off

  private:
    // An upright box in the plane, each number four times.
    struct Extent {
        std::array<Float4, 2> low = {};
        std::array<Float4, 2> high = {};
    };
    static Extent extent_of(const ReachBox& box);
    static Int4 is_apart(const ReachedTriangles4& reached, const Extent& box);
    ReachedTriangles4 place(const Triangles4& four) const;

    OrientedBox box_;
    double rounding_margin_m_;
    std::array<std::array<Float4, 3>, 3> axis_ = {};  // by axis of disc space, coordinate
    std::array<Float4, 3> base_ = {};                 // about the tree's origin
    Float4 rounding_margin_ = {};
    Float4 half_width_ = {};
    Float4 squared_radius_ = {};
    Float4 farthest_ = {};
    Extent whole_;
    std::array<Extent, k_max_disc_links> boxes_ = {};
    std::uint32_t box_count_;
};

}  // namespace handhold
