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

    // No more than the triangle's distance, squared: that of a box around it, turned as the middle
    // is.
    double least_squared(const Corners& corners) const {
        std::array<double, 3> along = {};
        std::array<double, 3> beside = {};
        for (std::size_t i = 0; i < 3; ++i) {
            const double x = corners[i].x() - from_.x();
            const double y = corners[i].y() - from_.y();
            along[i] = x * along_.x() + y * along_.y();
            beside[i] = y * along_.x() - x * along_.y();
        }
        const auto [low, high] = std::minmax({along[0], along[1], along[2]});
        const auto [left, right] = std::minmax({beside[0], beside[1], beside[2]});
        const auto [under, over] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
        const double ahead_m = distance_between(low, high, 0.0, length_m_);
        const double beside_m = distance_between(left, right, 0.0, 0.0);
        const double across_m = distance_between(under, over, 0.0, 0.0);
        return ahead_m * ahead_m + beside_m * beside_m + across_m * across_m;
    }

  private:
    Vec2 from_;
    Vec2 along_ = Vec2::UnitX();
    double length_m_;
};

// The reach in a mesh's frame.
class ReachSlab {
  public:
    // `base` in the mesh's frame; `center`: of the disc, where boxes are asked about.
    ReachSlab(const ChainReach& reach, const Pose& base, const Vec3& center)
        : x_axis_(base.rotation * -Vec3::UnitZ()),
          y_axis_(base.rotation * -Vec3::UnitY()),
          across_(base.rotation * -Vec3::UnitX()),
          x_steepness_(x_axis_.cwiseAbs()),
          y_steepness_(y_axis_.cwiseAbs()),
          steepness_(across_.cwiseAbs()),
          center_(center),
          low_(reach.box.low.cwiseMax(-reach.radius_m)),
          high_(reach.box.high.cwiseMin(reach.radius_m)),
          half_width_m_(reach.half_width_m),
          radius_m2_(reach.radius_m * reach.radius_m),
          far_m2_(radius_m2_ + half_width_m_ * half_width_m_) {}

    // Of an upright box.
    bool may_meet(const Vec3& middle, const Vec3& half) const {
        const Vec3 to_box = middle - center_;
        if (std::abs(across_.dot(to_box)) > steepness_.dot(half) + half_width_m_) {
            return false;
        }
        const double x = x_axis_.dot(to_box);
        const double x_half = x_steepness_.dot(half);
        const double y = y_axis_.dot(to_box);
        const double y_half = y_steepness_.dot(half);
        return x - x_half <= high_.x() && x + x_half >= low_.x() && y - y_half <= high_.y() &&
               y + y_half >= low_.y() &&
               (to_box.cwiseAbs() - half).cwiseMax(0.0).squaredNorm() <= far_m2_;
    }

    // True where the triangle may be in reach: then its corners in disc space, and the box around
    // them. Most of what a leaf brings lies beside the slab.
    bool place(const Corners& from_base, Corners& corners, ReachBox& box) const {
        const std::array<double, 3> z = {across_.dot(from_base[0]), across_.dot(from_base[1]),
                                         across_.dot(from_base[2])};
        if (std::min({z[0], z[1], z[2]}) > half_width_m_ ||
            std::max({z[0], z[1], z[2]}) < -half_width_m_) {
            return false;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = {x_axis_.dot(from_base[i]), y_axis_.dot(from_base[i]), z[i]};
        }
        box.low =
            corners[0].head<2>().cwiseMin(corners[1].head<2>()).cwiseMin(corners[2].head<2>());
        box.high =
            corners[0].head<2>().cwiseMax(corners[1].head<2>()).cwiseMax(corners[2].head<2>());
        return box.low.x() <= high_.x() && box.high.x() >= low_.x() && box.low.y() <= high_.y() &&
               box.high.y() >= low_.y() &&
               box.low.cwiseMax(-box.high).cwiseMax(0.0).squaredNorm() <= radius_m2_;
    }

    Vec3 turned(const Vec3& direction) const {
        return {x_axis_.dot(direction), y_axis_.dot(direction), across_.dot(direction)};
    }

  private:
    Vec3 x_axis_;
    Vec3 y_axis_;
    Vec3 across_;
    Vec3 x_steepness_;
    Vec3 y_steepness_;
    Vec3 steepness_;
    Vec3 center_;
    Vec2 low_;
    Vec2 high_;
    double half_width_m_;
    double radius_m2_;
    double far_m2_;
};

}  // namespace

void ChainPatch::gather(const ChainReach& reach, std::span<const PlacedMesh> meshes) {
    boxes_.clear();
    triangles_.clear();
    boxes_.reserve(k_usual_triangles);
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
    const Pose base = inverse(placed.pose) * reach.base;
    const ReachSlab slab(reach, base, base.position - bvh.origin());
    bvh.visit_boxes(
        [&](const Vec3& low, const Vec3& high) {
            const Vec3 half = 0.5 * (high - low);
            return slab.may_meet(low + half, half);
        },
        [&](std::uint32_t number) {
            const auto& [a, b, c] = surface.triangles[number];
            const Corners from_base = {surface.positions[a] - base.position,
                                       surface.positions[b] - base.position,
                                       surface.positions[c] - base.position};
            Triangle triangle;
            ReachBox box;
            if (slab.place(from_base, triangle.corners, box)) {
                triangle.normal = slab.turned(surface.normals[number]);
                triangle.number = number;
                boxes_.push_back(box);
                triangles_.push_back(triangle);
            }
        });
}

std::size_t ChainPatch::cut(double offset_m, std::uint32_t plane,
                            std::vector<DiscSegment>& segments) const {
    const std::size_t before = segments.size();
    std::size_t of_first_mesh = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const Corners& corners = triangles_[t].corners;
        const std::array<bool, 3> over = {corners[0].z() >= offset_m, corners[1].z() >= offset_m,
                                          corners[2].z() >= offset_m};
        if (over[0] == over[1] && over[1] == over[2]) {
            continue;
        }
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
    const Middle middle(middle_ds);
    const std::array<Vec3, 2> segment = {Vec3(middle_ds[0].x(), middle_ds[0].y(), 0.0),
                                         Vec3(middle_ds[1].x(), middle_ds[1].y(), 0.0)};
    const Vec2 low = middle_ds[0].cwiseMin(middle_ds[1]);
    const Vec2 high = middle_ds[0].cwiseMax(middle_ds[1]);
    double nearest_m = radius_m;
    SunkCapsule sunk;
    for (std::size_t t = 0; t < boxes_.size(); ++t) {
        const ReachBox& box = boxes_[t];
        if (box.low.x() > high.x() + nearest_m || box.high.x() < low.x() - nearest_m ||
            box.low.y() > high.y() + nearest_m || box.high.y() < low.y() - nearest_m) {
            continue;
        }
        const auto& [corners, normal, number] = triangles_[t];
        const double height_0 = normal.dot(segment[0] - corners[0]);
        const double height_1 = normal.dot(segment[1] - corners[0]);
        if (std::min(height_0, height_1) > nearest_m || std::max(height_0, height_1) < -nearest_m ||
            middle.least_squared(corners) > nearest_m * nearest_m) {
            continue;
        }
        const SegmentTriangle found = nearest_between(segment, corners, normal);
        nearest_m = std::min(nearest_m, found.distance_m);
        if (found.distance_m == 0.0 && middle.length_m() > 0.0) {
            const double share = (found.on_segment - segment[0]).norm() / middle.length_m();
            sunk.crossed_at = std::min(sunk.crossed_at.value_or(1.0), share);
        }
    }
    sunk.depth_m = radius_m - nearest_m;
    return sunk;
}

}  // namespace handhold
