#include "engine/geometry/reach_slab.hpp"

#include <algorithm>

namespace handhold {
ReachSlab::ReachSlab(const ChainReach& reach, const Pose& base, const TriangleBvh& bvh)
    : box_count_(reach.box_count) {
    // Ten roundings lie between a corner and its place, of numbers no larger than these.
    constexpr double k_rounding = 0x1p-20;
    const Vec3 middle = base.position - bvh.origin();
    spare_m_ = k_rounding * (bvh.reach_m() + middle.norm() + reach.radius_m);
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
    const Vec2 half = 0.5 * (whole.high - whole.low);
    box_.middle = {box_.axis[0].dot(middle) + center.x(), box_.axis[1].dot(middle) + center.y(),
                   box_.axis[2].dot(middle)};
    box_.half = {half.x(), half.y(), reach.half_width_m};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t along = 0; along < 3; ++along) {
            axis_[i][along] = four_times(box_.axis[i][static_cast<Eigen::Index>(along)]);
        }
        base_[i] = four_times(middle[static_cast<Eigen::Index>(i)]);
    }
    spare_ = four_times(spare_m_);
    half_width_ = four_times(reach.half_width_m * (1.0 + k_rounding));
    squared_radius_ = four_times(reach.radius_m * reach.radius_m * (1.0 + k_rounding));
    farthest_ = four_times(2.0 * reach.radius_m);
}

ReachSlab::Extent ReachSlab::extent_of(const ReachBox& box) {
    constexpr float k_rounding = 0x1p-20F;
    Extent extent;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const FourFloats low = four_times(box.low[axis]);
        const FourFloats high = four_times(box.high[axis]);
        extent.low[i] = low - k_rounding * higher(low, -low);
        extent.high[i] = high + k_rounding * higher(high, -high);
    }
    return extent;
}

FourInts ReachSlab::is_apart(const FourReached& reached, const Extent& box) {
    return (reached.low[0] > box.high[0]) | (reached.high[0] < box.low[0]) |
           (reached.low[1] > box.high[1]) | (reached.high[1] < box.low[1]);
}

FourReached ReachSlab::place(const FourTriangles& four) const {
    FourReached reached;
    std::array<std::array<FourFloats, 3>, 3> from_base;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t along = 0; along < 3; ++along) {
            from_base[c][along] = four.corner[c][along] - base_[along];
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto along_axis = [&](std::size_t c) -> FourFloats {
            return axis_[i][0] * from_base[c][0] + axis_[i][1] * from_base[c][1] +
                   axis_[i][2] * from_base[c][2];
        };
        const FourFloats a = along_axis(0);
        const FourFloats b = along_axis(1);
        const FourFloats c = along_axis(2);
        const FourFloats normal = axis_[i][0] * four.normal[0] + axis_[i][1] * four.normal[1] +
                                  axis_[i][2] * four.normal[2];
        reached.low[i] = lower(lower(a, b), c) - spare_;
        reached.high[i] = higher(higher(a, b), c) + spare_;
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

FourReached ReachSlab::bounds_of(const FourTriangles& four, FourNear& is_near) const {
    FourReached reached = place(four);
    const FourFloats zero = {};
    const FourFloats out_x = higher(higher(reached.low[0], -reached.high[0]), zero);
    const FourFloats out_y = higher(higher(reached.low[1], -reached.high[1]), zero);
    const FourInts is_out = (reached.low[2] > half_width_) | (reached.high[2] < -half_width_) |
                            is_apart(reached, whole_) |
                            (out_x * out_x + out_y * out_y > squared_radius_);
    is_near[0] = ~is_out;
    for (std::uint32_t i = 0; i < box_count_; ++i) {
        is_near[i] = ~(is_out | is_apart(reached, boxes_[i]));
    }
    for (std::size_t i = 0; i < 2; ++i) {
        reached.low[i] = lower(higher(reached.low[i], -farthest_), farthest_);
        reached.high[i] = lower(higher(reached.high[i], -farthest_), farthest_);
    }
    return reached;
}

}  // namespace handhold
