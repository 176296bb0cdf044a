#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// Conservative float test for the triangles within one chain's reach, four at a time.
namespace handhold {

// An axis-aligned box in disc space.
struct ReachBox {
    Vec2 low = Vec2::Constant(-std::numeric_limits<double>::infinity());
    Vec2 high = Vec2::Constant(std::numeric_limits<double>::infinity());
};

// Region that a chain's links can reach: a disc with a thickness, restricted to one box per link.
struct ChainReach {
    Pose base;            // first hinge; links at angle 0 point along -Z; positive angles turn them
                          // towards -Y
    double radius_m = 0;  // distance from the first hinge, in the plane
    double half_width_m = 0;                            // half extent across the plane
    std::array<ReachBox, k_max_disc_links> boxes = {};  // boxes in the plane
    std::uint32_t box_count = 0;                        // 0: the whole disc
};

// Four triangles in disc space (_ds, disc_contact.hpp; third axis across the plane). The bounds
// include a margin for float rounding.
struct ReachedTriangles4 {
    std::array<Float4, 3> low = {};
    std::array<Float4, 3> high = {};
    // The line in which a triangle's plane meets the chain's plane: line[0] x + line[1] y =
    // line[2]. All 0 if the triangle's normal is unknown.
    std::array<Float4, 3> line = {};
    Corners4 corner = {};
};

// Which of four triangles may reach into each box of the reach. Without boxes, the first mask is
// for the whole disc.
using ReachMasks4 = std::array<Int4, k_max_disc_links>;

// A chain's reach in the frame of a triangle tree.
class ReachSlab {
  public:
    // `base` is reach.base in the mesh's frame.
    ReachSlab(const ChainReach& reach, const Pose& base, const TriangleBvh& bvh);

    // A box that contains the reach, relative to the tree's origin.
    const OrientedBox& box() const { return box_; }

    // The triangles in disc space. Bounds in the plane are clamped to twice the reach's radius:
    // floats are inaccurate farther out, and nothing there is in reach.
    ReachedTriangles4 bounds_of(const Triangles4& four, ReachMasks4& is_near) const;

    double rounding_margin_m() const {
        return rounding_margin_m_;
    }  // upper bound on the float rounding error

  private:
    // An axis-aligned box in the plane; each number is in all lanes.
    struct Extent {
        std::array<Float4, 2> low = {};
        std::array<Float4, 2> high = {};
    };
    static Extent extent_of(const ReachBox& box);
    static Int4 is_apart(const ReachedTriangles4& reached, const Extent& box);
    ReachedTriangles4 place(const Triangles4& four) const;

    OrientedBox box_;
    double rounding_margin_m_;
    std::array<std::array<Float4, 3>, 3> axis_ = {};  // [disc axis][mesh coordinate]
    std::array<Float4, 3> base_ = {};                 // relative to the tree's origin
    Float4 rounding_margin_ = {};
    Float4 half_width_ = {};
    Float4 squared_radius_ = {};
    Float4 max_coordinate_ = {};
    Extent whole_;
    std::array<Extent, k_max_disc_links> boxes_ = {};
    std::uint32_t box_count_;
};

}  // namespace handhold
