#include "engine/geometry/reach_slab.hpp"

#include <algorithm>

namespace handhold {
ReachSlab::ReachSlab(const ChainReach& reach, const Pose& base, const TriangleBvh& bvh)
    : box_count_(reach.box_count) {
    // Relative rounding error per unit of the lengths below (BVH reach, distance, chain radius): at
    // most ten float roundings, each at most 2^-24.
    constexpr double k_rounding = 0x1p-20;
    const Vec3 centre = base.position - bvh.origin();
    rounding_margin_m_ = k_rounding * (bvh.reach_m() + centre.norm() + reach.radius_m);
    const Vec2 corner = Vec2::Constant(reach.radius_m);
    ReachBox boxes = {corner, -corner};
    for (std::uint32_t i = 0; i < box_count_; ++i) {
        boxes.low = boxes.low.cwiseMin(reach.boxes[i].low);
        boxes.high = boxes.high.cwiseMax(reach.boxes[i].high);
        boxes_[i] = extent_of(reach.boxes[i]);
    }
    const ReachBox whole = box_count_ == 0
                               ? ReachBox{-corner, corner}
                               : ReachBox{boxes.low.cwiseMax(-corner), boxes.high.cwiseMin(corner)};
    whole_ = extent_of(whole);

    box_.axis = {base.rotation * -Vec3::UnitZ(), base.rotation * -Vec3::UnitY(),
                 base.rotation * -Vec3::UnitX()};
    const Vec2 center = 0.5 * (whole.low + whole.high);
    const Vec2 half_extents = 0.5 * (whole.high - whole.low);
    box_.centre = {box_.axis[0].dot(centre) + center.x(), box_.axis[1].dot(centre) + center.y(),
                   box_.axis[2].dot(centre)};
    box_.half_extents = {half_extents.x(), half_extents.y(), reach.half_width_m};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t along = 0; along < 3; ++along) {
            axis_[i][along] = splat4(box_.axis[i][static_cast<Eigen::Index>(along)]);
        }
        base_[i] = splat4(centre[static_cast<Eigen::Index>(i)]);
    }
    rounding_margin_ = splat4(rounding_margin_m_);
    half_width_ = splat4(reach.half_width_m * (1.0 + k_rounding));
    squared_radius_ = splat4(reach.radius_m * reach.radius_m * (1.0 + k_rounding));
    max_coordinate_ = splat4(2.0 * reach.radius_m);
}

ReachSlab::Extent ReachSlab::extent_of(const ReachBox& box) {
    constexpr float k_rounding = 0x1p-20F;
    Extent extent;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const Float4 low = splat4(box.low[axis]);
        const Float4 high = splat4(box.high[axis]);
        extent.low[i] = low - k_rounding * higher(low, -low);
        extent.high[i] = high + k_rounding * higher(high, -high);
    }
    return extent;
}

Int4 ReachSlab::is_apart(const ReachedTriangles4& reached, const Extent& box) {
    return (reached.low[0] > box.high[0]) | (reached.high[0] < box.low[0]) |
           (reached.low[1] > box.high[1]) | (reached.high[1] < box.low[1]);
}

ReachedTriangles4 ReachSlab::place(const Triangles4& four) const {
    ReachedTriangles4 reached;
    std::array<std::array<Float4, 3>, 3> from_base;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t along = 0; along < 3; ++along) {
            from_base[c][along] = four.corner[c][along] - base_[along];
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto along_axis = [&](std::size_t c) -> Float4 {
            return axis_[i][0] * from_base[c][0] + axis_[i][1] * from_base[c][1] +
                   axis_[i][2] * from_base[c][2];
        };
        const Float4 a = along_axis(0);
        const Float4 b = along_axis(1);
        const Float4 c = along_axis(2);
        const Float4 normal = axis_[i][0] * four.normal[0] + axis_[i][1] * four.normal[1] +
                              axis_[i][2] * four.normal[2];
        reached.low[i] = lower(lower(a, b), c) - rounding_margin_;
        reached.high[i] = higher(higher(a, b), c) + rounding_margin_;
        reached.line[2] += normal * a;
        if (i < 2) {
            reached.line[i] = normal;
        }
        reached.corner[0][i] = a;
        reached.corner[1][i] = b;
        reached.corner[2][i] = c;
    }
    return reached;
}

ReachedTriangles4 ReachSlab::bounds_of(const Triangles4& four, ReachMasks4& is_near) const {
    ReachedTriangles4 reached = place(four);
    const Float4 zero = {};
    const Float4 out_x = higher(higher(reached.low[0], -reached.high[0]), zero);
    const Float4 out_y = higher(higher(reached.low[1], -reached.high[1]), zero);
    const Int4 is_out = (reached.low[2] > half_width_) | (reached.high[2] < -half_width_) |
                        is_apart(reached, whole_) |
                        (out_x * out_x + out_y * out_y > squared_radius_);
    is_near[0] = ~is_out;
    for (std::uint32_t i = 0; i < box_count_; ++i) {
        is_near[i] = ~(is_out | is_apart(reached, boxes_[i]));
    }
    for (std::size_t i = 0; i < 2; ++i) {
        reached.low[i] = lower(higher(reached.low[i], -max_coordinate_), max_coordinate_);
        reached.high[i] = lower(higher(reached.high[i], -max_coordinate_), max_coordinate_);
    }
    return reached;
}

}  // namespace handhold
