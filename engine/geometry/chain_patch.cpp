#include "engine/geometry/chain_patch.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/disc_trace.hpp"
#include "engine/geometry/plane_cut4.hpp"
#include "engine/geometry/segment_distances4.hpp"
#include "engine/geometry/segment_triangle.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_usual_fours = 1024;  // groups of four triangles; more only on dense meshes

}  // namespace

// Distance from a capsule's axis to triangles. Collects candidates by float lower bounds, then
// tests them exactly, nearest bound first.
class ChainPatch::PenetrationSearch {
  public:
    PenetrationSearch(const std::array<Vec2, 2>& middle_ds, double radius_m,
                      double rounding_margin_m)
        : segment_({Vec3(middle_ds[0].x(), middle_ds[0].y(), 0.0),
                    Vec3(middle_ds[1].x(), middle_ds[1].y(), 0.0)}),
          length_m_((middle_ds[1] - middle_ds[0]).norm()),
          radius_m_(radius_m),
          nearest_m_(radius_m),
          rounding_margin_m_(rounding_margin_m) {
        const Vec2 along =
            length_m_ > 0.0 ? Vec2((middle_ds[1] - middle_ds[0]) / length_m_) : Vec2::UnitX();
        for (std::size_t i = 0; i < 2; ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            begin_[i] = splat4(middle_ds[0][axis]);
            end_[i] = splat4(middle_ds[1][axis]);
            along_[i] = splat4(along[axis]);
        }
        length_ = splat4(length_m_);
        update_limits();
    }

    // Adds the triangles of a group of four that may be nearer than the nearest found so far.
    // `number`: place of the first of the four (ChainPatch::exact).
    void add_candidates(const ReachedTriangles4& four, const Int4& is_wanted,
                        std::uint32_t number) {
        Int4 is_near = is_wanted & is_in_box(four);
        if (!any_of(is_near)) {
            return;
        }
        is_near &= ~is_off_plane(four);
        const Corners4 corner = to_axis_frame(four);
        is_near &= bounds_squared(corner) <= max_squared_;
        if (!any_of(is_near)) {
            return;
        }
        const Float4 squared = SegmentDistances4(corner, length_).squared();
        is_near &= squared <= max_squared_;
        for (std::uint32_t i = 0; i < 4; ++i) {
            candidates_[count_] = {squared[i], number + i};
            count_ += is_near[i] != 0 ? 1U : 0U;
        }
    }
    // True if fewer than four more candidates fit.
    bool is_full() const { return count_ + 4 > candidates_.size(); }

    // Removes and returns the candidate with the smallest bound; nullopt if there is none.
    std::optional<std::uint32_t> pop_nearest() {
        if (count_ == 0) {
            return std::nullopt;
        }
        std::size_t best = 0;
        for (std::size_t i = 1; i < count_; ++i) {
            best = candidates_[i].squared < candidates_[best].squared ? i : best;
        }
        const Candidate first = candidates_[best];
        candidates_[best] = candidates_[--count_];
        return first.number;
    }
    void test(const Triangle& triangle) {
        const SegmentTriangle found = nearest_between(segment_, triangle.corners, triangle.normal);
        if (found.distance_m < nearest_m_) {
            nearest_m_ = found.distance_m;
            update_limits();
            drop_far_candidates();
        }
        if (found.distance_m == 0.0 && length_m_ > 0.0) {
            const double share = (found.on_segment - segment_[0]).norm() / length_m_;
            crossed_at_ = std::min(crossed_at_.value_or(1.0), share);
        }
    }

    CapsulePenetration found() const { return {radius_m_ - nearest_m_, nearest_m_, crossed_at_}; }

  private:
    struct Candidate {
        float squared;  // lower bound on the squared distance, up to rounding
        std::uint32_t number;
    };

    // True for triangles whose bounding box overlaps the search limits. Rejects most triangles.
    Int4 is_in_box(const ReachedTriangles4& four) const {
        const Int4 is_far = (four.low[0] > high_[0]) | (four.low[1] > high_[1]) |
                            (four.high[0] < low_[0]) | (four.high[1] < low_[1]) |
                            (four.low[2] > max_m_) | (four.high[2] < -max_m_);
        return ~is_far;
    }
    // True for triangles whose plane is farther than max_m_ from the axis.
    Int4 is_off_plane(const ReachedTriangles4& four) const {
        const Float4 begin = four.line[0] * begin_[0] + four.line[1] * begin_[1] - four.line[2];
        const Float4 end = four.line[0] * end_[0] + four.line[1] * end_[1] - four.line[2];
        return (lower(begin, end) > max_m_) | (higher(begin, end) < -max_m_);
    }

    // Rotates the corners into the axis's frame: the origin is the axis's first end, +X points
    // along it.
    Corners4 to_axis_frame(const ReachedTriangles4& four) const {
        Corners4 corner;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 x = four.corner[i][0] - begin_[0];
            const Float4 y = four.corner[i][1] - begin_[1];
            corner[i][0] = x * along_[0] + y * along_[1];
            corner[i][1] = y * along_[0] - x * along_[1];
            corner[i][2] = four.corner[i][2];
        }
        return corner;
    }
    // Lower bound on the squared distance: that of the triangle's bounding box from the axis.
    Float4 bounds_squared(const Corners4& corner) const {
        const Float4 zero = {};
        const auto beyond = [&](std::size_t axis, const Float4& upper) -> Float4 {
            const Float4 low = lower(lower(corner[0][axis], corner[1][axis]), corner[2][axis]);
            const Float4 high = higher(higher(corner[0][axis], corner[1][axis]), corner[2][axis]);
            return higher(higher(low - upper, -high), zero);
        };
        const Float4 ahead = beyond(0, length_);
        const Float4 aside = beyond(1, zero);
        const Float4 across = beyond(2, zero);
        return ahead * ahead + aside * aside + across * across;
    }

    // Shrinks the limits to the nearest distance found so far.
    void update_limits() {
        constexpr double k_rounding = 1e-5;
        const double max_m = nearest_m_ * (1.0 + k_rounding) + 4.0 * rounding_margin_m_;
        max_m_ = splat4(max_m);
        max_squared_ = splat4(max_m * max_m);
        for (std::size_t i = 0; i < 2; ++i) {
            low_[i] = lower(begin_[i], end_[i]) - max_m_;
            high_[i] = higher(begin_[i], end_[i]) + max_m_;
        }
    }
    void drop_far_candidates() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            candidates_[kept] = candidates_[i];
            kept += candidates_[i].squared <= max_squared_[0] ? 1U : 0U;
        }
        count_ = kept;
    }

    std::array<Vec3, 2> segment_;
    double length_m_;
    double radius_m_;
    double nearest_m_;
    double rounding_margin_m_;
    std::optional<double> crossed_at_;
    // The axis and its search limits, each number repeated in all lanes.
    std::array<Float4, 2> begin_;
    std::array<Float4, 2> end_;
    std::array<Float4, 2> along_;
    std::array<Float4, 2> low_;
    std::array<Float4, 2> high_;
    Float4 length_ = {};
    Float4 max_m_ = {};
    Float4 max_squared_ = {};
    std::array<Candidate, 64> candidates_;  // NOLINT(*-member-init): filled as it grows
    std::size_t count_ = 0;
};

ChainPatch::Frame::Frame(const GripMesh& mesh, const Pose& base, std::size_t first)
    : mesh_(&mesh),
      first_(first),
      base_(base.position),
      x_axis_(base.rotation * -Vec3::UnitZ()),
      y_axis_(base.rotation * -Vec3::UnitY()),
      across_(base.rotation * -Vec3::UnitX()) {}

Vec3 ChainPatch::Frame::turned(const Vec3& direction) const {
    return {
        x_axis_.x() * direction.x() + (x_axis_.y() * direction.y() + x_axis_.z() * direction.z()),
        y_axis_.x() * direction.x() + (y_axis_.y() * direction.y() + y_axis_.z() * direction.z()),
        across_.dot(direction)};
}

std::uint32_t ChainPatch::Frame::number(std::uint32_t slot) const {
    return mesh_->contact_bvh.number_at(slot);
}

ChainPatch::Triangle ChainPatch::Frame::triangle(std::uint32_t slot) const {
    const Corners corners = mesh_->contact_bvh.corners_at(slot);
    const Corners corners_ds = {turned(corners[0] - base_), turned(corners[1] - base_),
                                turned(corners[2] - base_)};
    return {corners_ds, turned(mesh_->contact.normals[number(slot)])};
}

void ChainPatch::gather(const ChainReach& reach, std::span<const PlacedMesh> meshes) {
    fours_.clear();
    is_near_.clear();
    first_slot_.clear();
    triangles_.clear();
    frames_.clear();
    fours_.reserve(k_usual_fours);
    is_near_.reserve(k_usual_fours);
    first_slot_.reserve(k_usual_fours);
    placed_.reserve(k_usual_fours);
    triangles_.reserve(2 * k_usual_fours);
    for (std::vector<Boxed>& boxed : boxed_) {
        boxed.clear();
        boxed.reserve(k_usual_fours);
    }
    rounding_margin_m_ = 0.0;
    radius_m_ = reach.radius_m;
    box_count_ = std::max(reach.box_count, 1U);
    for (const PlacedMesh& placed : meshes) {
        gather_mesh(reach, placed);
    }
    placed_.assign(fours_.size(), {k_not_placed, k_not_placed, k_not_placed, k_not_placed});
}

void ChainPatch::gather_mesh(const ChainReach& reach, const PlacedMesh& placed) {
    // Rounding error of the query in floats, for coordinates below 4 m.
    constexpr double k_float_rounding_m = 1e-6;
    constexpr std::array<Int4, 5> k_first = {Int4{0, 0, 0, 0}, Int4{-1, 0, 0, 0},
                                             Int4{-1, -1, 0, 0}, Int4{-1, -1, -1, 0},
                                             Int4{-1, -1, -1, -1}};
    const TriangleBvh& bvh = placed.mesh->contact_bvh;
    const Pose base = inverse(placed.pose) * reach.base;
    frames_.emplace_back(*placed.mesh, base, fours_.size());
    const ReachSlab slab(reach, base, bvh);
    rounding_margin_m_ =
        std::max(rounding_margin_m_, slab.rounding_margin_m() + k_float_rounding_m);
    const auto take = [&](std::uint32_t first_slot, std::uint32_t count,
                          const Triangles4& triangles) {
        ReachMasks4 is_near;
        const ReachedTriangles4 reached = slab.bounds_of(triangles, is_near);
        Int4 is_near_any = {};
        for (std::size_t box = 0; box < box_count_; ++box) {
            is_near[box] &= k_first[count];
            is_near_any |= is_near[box];
            if (any_of(is_near[box])) {
                boxed_[box].push_back({is_near[box], static_cast<std::uint32_t>(fours_.size())});
            }
        }
        if (any_of(is_near_any)) {
            fours_.push_back(reached);
            is_near_.push_back(is_near_any);
            first_slot_.push_back(first_slot);
        }
    };
    bvh.visit_near_box(slab.box(), take);
}

std::size_t ChainPatch::size() const {
    std::size_t count = 0;
    for (const Int4& is_near : is_near_) {
        for (std::size_t i = 0; i < 4; ++i) {
            count += is_near[i] != 0 ? 1U : 0U;
        }
    }
    return count;
}

const ChainPatch::Triangle& ChainPatch::exact(std::uint32_t place) {
    const std::size_t four = place / 4;
    std::uint32_t& placed = placed_[four][place % 4];
    if (placed == k_not_placed) {
        placed = static_cast<std::uint32_t>(triangles_.size());
        const auto beyond = std::find_if(frames_.begin() + 1, frames_.end(),
                                         [&](const Frame& frame) { return frame.first() > four; });
        triangles_.push_back((beyond - 1)->triangle(first_slot_[four] + place % 4));
    }
    return triangles_[placed];
}

std::size_t ChainPatch::cut(double offset_m, std::uint32_t plane,
                            std::vector<DiscSegment>& segments) {
    const std::size_t before = segments.size();
    std::size_t of_first_mesh = 0;
    const PlaneCut4 cut(offset_m, radius_m_);
    for (std::size_t mesh = 0; mesh < frames_.size(); ++mesh) {
        const std::size_t end =
            mesh + 1 < frames_.size() ? frames_[mesh + 1].first() : fours_.size();
        for (std::size_t f = frames_[mesh].first(); f < end; ++f) {
            const Segments4 found = cut.of(fours_[f].corner, is_near_[f]);
            for (std::uint32_t i = 0; any_of(found.is_near) && i < 4; ++i) {
                if (found.is_near[i] != 0) {
                    const auto number = frames_[mesh].number(first_slot_[f] + i);
                    add_near_part({found.end(0, i), found.end(1, i), plane, number}, radius_m_,
                                  segments);
                }
            }
        }
        of_first_mesh = mesh == 0 ? segments.size() - before : of_first_mesh;
    }
    return of_first_mesh;
}

CapsulePenetration ChainPatch::find_penetration(const std::array<Vec2, 2>& middle_ds,
                                                double radius_m, std::size_t box) {
    PenetrationSearch search(middle_ds, radius_m, rounding_margin_m_);
    const auto test_candidates = [&]() {
        while (const auto candidate = search.pop_nearest()) {
            search.test(exact(*candidate));
        }
    };
    for (const Boxed& boxed : boxed_[std::min(box, box_count_ - 1)]) {
        search.add_candidates(fours_[boxed.four], boxed.is_near, 4 * boxed.four);
        if (search.is_full()) {
            test_candidates();
        }
    }
    test_candidates();
    return search.found();
}

}  // namespace handhold
