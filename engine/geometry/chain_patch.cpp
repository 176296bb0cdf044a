#include "engine/geometry/chain_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/disc_trace.hpp"
#include "engine/geometry/segment_triangle.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_usual_triangles = 2048;  // more than one chain meets but on dense meshes

double distance_between(double low_a, double high_a, double low_b, double high_b) {
    return std::max({low_a - high_b, low_b - high_a, 0.0});
}

// A capsule's middle, and directions along it and beside it.
class Middle {
  public:
    explicit Middle(const std::array<Vec2, 2>& ends)
        : from_(ends[0]), length_m_((ends[1] - ends[0]).norm()) {
        if (length_m_ > 0.0) {
            along_ = (ends[1] - ends[0]) / length_m_;
        }
    }

    double length_m() const { return length_m_; }

    // No more than the triangle's distance in the plane, squared: that of a box around it, turned
    // as the middle is.
    double least_squared(const Corners& corners) const {
        std::array<double, 3> along = {};
        std::array<double, 3> beside = {};
        for (std::size_t i = 0; i < 3; ++i) {
            const double x = corners[i].x() - from_.x();
            const double y = corners[i].y() - from_.y();
            along[i] = x * along_.x() + y * along_.y();
            beside[i] = y * along_.x() - x * along_.y();
        }
        const double ahead_m = distance_between(least(along), most(along), 0.0, length_m_);
        const double beside_m = distance_between(least(beside), most(beside), 0.0, 0.0);
        return ahead_m * ahead_m + beside_m * beside_m;
    }

  private:
    static double least(const std::array<double, 3>& of) {
        return std::min(of[0], std::min(of[1], of[2]));
    }
    static double most(const std::array<double, 3>& of) {
        return std::max(of[0], std::max(of[1], of[2]));
    }

    Vec2 from_;
    Vec2 along_ = Vec2::UnitX();
    double length_m_;
};

// As wide as what every processor of the kind compares at once; math/four.hpp's are compared one by
// one where there is no AVX.
using Two = double __attribute__((vector_size(16)));

Two lower(const Two& a, const Two& b) { return a < b ? a : b; }
Two higher(const Two& a, const Two& b) { return a > b ? a : b; }

bool any_above(const Two& values, const Two& limits) {
    using TwoLongs = std::int64_t __attribute__((vector_size(16)));
    const TwoLongs above = values > limits;
    return (above[0] | above[1]) != 0;
}

// A point in disc space.
struct Placed {
    Two xy;
    double across;
};
// A box in the plane.
struct Extent {
    Two low;
    Two high;
};
bool is_apart(const Extent& a, const Extent& b) {
    return any_above(a.low, b.high) || any_above(b.low, a.high);
}
Extent extent_of(const ReachBox& box) {
    return {Two{box.low.x(), box.low.y()}, Two{box.high.x(), box.high.y()}};
}
Vec3 to_vec3(const Placed& point) { return {point.xy[0], point.xy[1], point.across}; }

// The reach in a mesh's frame.
class ReachSlab {
  public:
    ReachSlab(const ChainReach& reach, const Pose& base)
        : base_(base.position),
          x_axis_(base.rotation * -Vec3::UnitZ()),
          y_axis_(base.rotation * -Vec3::UnitY()),
          across_(base.rotation * -Vec3::UnitX()),
          box_count_(reach.box_count),
          half_width_m_(reach.half_width_m),
          radius_m2_(reach.radius_m * reach.radius_m) {
        for (int i = 0; i < 3; ++i) {
            flat_[i] = Two{x_axis_[i], y_axis_[i]};
        }
        const Vec2 corner = Vec2::Constant(reach.radius_m);
        ReachBox boxes = {corner, -corner};
        for (std::uint32_t i = 0; i < box_count_; ++i) {
            boxes.low = boxes.low.cwiseMin(reach.boxes[i].low);
            boxes.high = boxes.high.cwiseMax(reach.boxes[i].high);
            links_[i] = extent_of(reach.boxes[i]);
        }
        whole_ = box_count_ == 0
                     ? ReachBox{-corner, corner}
                     : ReachBox{boxes.low.cwiseMax(-corner), boxes.high.cwiseMin(corner)};
        all_ = extent_of(whole_);
    }

    // About `origin`.
    TurnedBox box_about(const Vec3& origin) const {
        const Vec3 base = base_ - origin;
        const Vec2 middle = 0.5 * (whole_.low + whole_.high);
        const Vec2 half = 0.5 * (whole_.high - whole_.low);
        return {{x_axis_, y_axis_, across_},
                {x_axis_.dot(base) + middle.x(), y_axis_.dot(base) + middle.y(), across_.dot(base)},
                {half.x(), half.y(), half_width_m_}};
    }

    Placed placed(const Vec3& point) const { return turned(Vec3(point - base_)); }
    Placed turned(const Vec3& direction) const {
        return {flat_[0] * direction.x() + (flat_[1] * direction.y() + flat_[2] * direction.z()),
                across_.dot(direction)};
    }

    bool is_beside(double low, double high) const {
        return low > half_width_m_ || high < -half_width_m_;
    }
    // True where what is in the box may be in reach.
    bool may_reach(const Extent& box) const {
        if (is_apart(box, all_)) {
            return false;
        }
        const Two out = higher(higher(box.low, -box.high), Two{0.0, 0.0});
        if (out[0] * out[0] + out[1] * out[1] > radius_m2_) {
            return false;
        }
        for (std::uint32_t i = 0; i < box_count_; ++i) {
            if (!is_apart(box, links_[i])) {
                return true;
            }
        }
        return box_count_ == 0;
    }

  private:
    Vec3 base_;
    Vec3 x_axis_;
    Vec3 y_axis_;
    Vec3 across_;
    Two flat_[3];  // by coordinate: of x and y  NOLINT(*-c-arrays): not of a vector's type
    std::uint32_t box_count_;
    double half_width_m_;
    double radius_m2_;
    std::array<Extent, k_most_disc_links> links_ = {};
    ReachBox whole_;  // around all that is in reach
    Extent all_ = {};
};

// What is farther out needs no place of its own, and a float would not know it well.
FlatBounds flat_bounds(const Extent& box, double most_m) {
    const Two most = Two{most_m, most_m};
    const Two low = lower(higher(box.low, -most), most);
    const Two high = lower(higher(box.high, -most), most);
    return {FourFloats{static_cast<float>(low[0]), static_cast<float>(low[1]),
                       static_cast<float>(-high[0]), static_cast<float>(-high[1])}};
}

// What bounds that are no farther from a box than this are not beyond.
FourFloats limits_around(const Vec2& low, const Vec2& high, double distance_m) {
    constexpr double k_rounding_m = 1e-6;  // of floats below 4 m; fingers are decimetres
    const double m = distance_m + k_rounding_m;
    return FourFloats{static_cast<float>(high.x() + m), static_cast<float>(high.y() + m),
                      static_cast<float>(m - low.x()), static_cast<float>(m - low.y())};
}

}  // namespace

// How near a capsule's middle comes to triangles: first those that may come near are noted, then
// they are looked at.
class ChainPatch::SunkSearch {
  public:
    SunkSearch(const std::array<Vec2, 2>& middle_ds, double radius_m)
        : middle_(middle_ds),
          ends_(middle_ds),
          segment_({Vec3(middle_ds[0].x(), middle_ds[0].y(), 0.0),
                    Vec3(middle_ds[1].x(), middle_ds[1].y(), 0.0)}),
          radius_m_(radius_m),
          nearest_m_(radius_m) {}

    FourFloats limits() const {
        return limits_around(ends_[0].cwiseMin(ends_[1]), ends_[0].cwiseMax(ends_[1]), nearest_m_);
    }
    // The middle is on one side of the triangle's plane, and too far from it.
    bool is_off(const Vec2& normal, double offset) const {
        constexpr double k_rounding_m = 1e-12;
        const double most_m = nearest_m_ + k_rounding_m;
        const double begin_m = normal.x() * ends_[0].x() + normal.y() * ends_[0].y() - offset;
        const double end_m = normal.x() * ends_[1].x() + normal.y() * ends_[1].y() - offset;
        return std::min(begin_m, end_m) > most_m || std::max(begin_m, end_m) < -most_m;
    }
    void note(std::uint32_t triangle, const Corners& corners, double across_m) {
        const double least = middle_.least_squared(corners) + across_m * across_m;
        if (least <= nearest_m_ * nearest_m_) {
            noted_[count_++] = {least, triangle};
        }
    }
    bool is_full() const { return count_ == noted_.size(); }

    // Of those noted the one that may be nearest, if it still matters.
    std::optional<std::uint32_t> next() {
        if (count_ == 0) {
            return std::nullopt;
        }
        std::size_t best = 0;
        for (std::size_t i = 1; i < count_; ++i) {
            best = noted_[i].least < noted_[best].least ? i : best;
        }
        const Noted first = noted_[best];
        noted_[best] = noted_[--count_];
        if (first.least > nearest_m_ * nearest_m_) {
            count_ = 0;
            return std::nullopt;
        }
        return first.triangle;
    }
    void look_at(const Corners& corners, const Vec3& normal) {
        const SegmentTriangle found = nearest_between(segment_, corners, normal);
        nearest_m_ = std::min(nearest_m_, found.distance_m);
        if (found.distance_m == 0.0 && middle_.length_m() > 0.0) {
            const double share = (found.on_segment - segment_[0]).norm() / middle_.length_m();
            crossed_at_ = std::min(crossed_at_.value_or(1.0), share);
        }
    }

    SunkCapsule found() const { return {radius_m_ - nearest_m_, nearest_m_, crossed_at_}; }

  private:
    struct Noted {
        double least;  // no more than its distance, squared
        std::uint32_t triangle;
    };
    Middle middle_;
    std::array<Vec2, 2> ends_;
    std::array<Vec3, 2> segment_;
    double radius_m_;
    double nearest_m_;
    std::optional<double> crossed_at_;
    std::array<Noted, 64> noted_;  // NOLINT(*-member-init): filled as it grows
    std::size_t count_ = 0;
};

void ChainPatch::gather(const ChainReach& reach, std::span<const PlacedMesh> meshes) {
    bounds_.clear();
    across_.clear();
    lines_.clear();
    triangles_.clear();
    bounds_.reserve(k_usual_triangles);
    across_.reserve(k_usual_triangles);
    lines_.reserve(k_usual_triangles);
    triangles_.reserve(k_usual_triangles);
    of_first_mesh_ = 0;
    radius_m_ = reach.radius_m;
    for (const PlacedMesh& placed : meshes) {
        gather_mesh(reach, placed);
        if (&placed == meshes.data()) {
            of_first_mesh_ = triangles_.size();
        }
    }
}

void ChainPatch::gather_mesh(const ChainReach& reach, const PlacedMesh& placed) {
    const SurfaceGraph& surface = placed.mesh->contact;
    const TriangleBvh& bvh = placed.mesh->contact_bvh;
    const ReachSlab slab(reach, inverse(placed.pose) * reach.base);
    const auto take = [&](std::uint32_t number, const Vec3& a, const Vec3& b, const Vec3& c) {
        const Placed a_ds = slab.placed(a);
        const Placed b_ds = slab.placed(b);
        const Placed c_ds = slab.placed(c);
        const double low = std::min(a_ds.across, std::min(b_ds.across, c_ds.across));
        const double high = std::max(a_ds.across, std::max(b_ds.across, c_ds.across));
        const Extent box = {lower(lower(a_ds.xy, b_ds.xy), c_ds.xy),
                            higher(higher(a_ds.xy, b_ds.xy), c_ds.xy)};
        if (slab.is_beside(low, high) || !slab.may_reach(box)) {
            return;
        }
        const Placed normal = slab.turned(surface.normals[number]);
        bounds_.push_back(flat_bounds(box, 2.0 * radius_m_));
        across_.push_back({low, high});
        lines_.push_back(
            {{normal.xy[0], normal.xy[1]},
             normal.xy[0] * a_ds.xy[0] + normal.xy[1] * a_ds.xy[1] + normal.across * a_ds.across});
        triangles_.push_back(
            {{to_vec3(a_ds), to_vec3(b_ds), to_vec3(c_ds)}, to_vec3(normal), number});
    };
    bvh.visit_near_box(slab.box_about(bvh.origin()), take);
}

std::size_t ChainPatch::cut(double offset_m, std::uint32_t plane,
                            std::vector<DiscSegment>& segments) const {
    const std::size_t before = segments.size();
    std::size_t of_first_mesh = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        if (across_[t].low >= offset_m || across_[t].high < offset_m) {
            continue;
        }
        const Corners& corners = triangles_[t].corners;
        const std::array<bool, 3> over = {corners[0].z() >= offset_m, corners[1].z() >= offset_m,
                                          corners[2].z() >= offset_m};
        // Of the three corners one is alone on its side: both cut edges begin there.
        const std::size_t alone = over[0] == over[1] ? 2 : (over[0] == over[2] ? 1 : 0);
        std::array<Vec2, 2> ends;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3& from = corners[alone];
            const Vec3& to = corners[(alone + 1 + i) % 3];
            const double share = (offset_m - from.z()) / (to.z() - from.z());
            ends[i] = (from + share * (to - from)).head<2>();
        }
        add_segment({ends[0], ends[1], plane, triangles_[t].number}, radius_m_, segments);
        if (t < of_first_mesh_) {
            of_first_mesh = segments.size() - before;
        }
    }
    return of_first_mesh;
}

SunkCapsule ChainPatch::find_sunk(const std::array<Vec2, 2>& middle_ds, double radius_m) const {
    SunkSearch search(middle_ds, radius_m);
    FourFloats limits = search.limits();
    for (std::size_t t = 0; t < bounds_.size(); ++t) {
        if (any_beyond(bounds_[t].value, limits) ||
            search.is_off(lines_[t].normal, lines_[t].offset)) {
            continue;
        }
        const double across_m = distance_between(across_[t].low, across_[t].high, 0.0, 0.0);
        search.note(static_cast<std::uint32_t>(t), triangles_[t].corners, across_m);
        if (search.is_full()) {
            settle(search);
            limits = search.limits();
        }
    }
    settle(search);
    return search.found();
}

// The nearest first, as far as that is known: it leaves out most of the others.
void ChainPatch::settle(SunkSearch& search) const {
    while (const auto next = search.next()) {
        search.look_at(triangles_[*next].corners, triangles_[*next].normal);
    }
}

}  // namespace handhold
