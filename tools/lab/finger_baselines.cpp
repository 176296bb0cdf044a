#include "tools/lab/finger_baselines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace handhold::lab {
namespace {

constexpr double k_detail_apart_m = 0.02;  // largest distance of the search detail from the surface
constexpr double k_rounding_m = 1e-9;

double length_from(const HingeChain& chain, std::size_t joint) {
    double length_m = 0.0;
    for (std::size_t i = joint; i < chain.link_count; ++i) {
        length_m += chain.length_m[i];
    }
    return length_m;
}

Disc disc_of(const HingeChain& chain) {
    Disc disc;
    disc.center = chain.base.position;
    disc.x_axis = chain.base.rotation * -Vec3::UnitZ();
    disc.y_axis = chain.base.rotation * -Vec3::UnitY();
    disc.normal = chain.base.rotation * -Vec3::UnitX();
    disc.radius_m = length_from(chain, 0);
    return disc;
}

// The sector that one joint sweeps with the straight rest of the finger, and the first contact in
// that sector.
class JointDisc {
  public:
    JointDisc(const Vec2& center, double direction_rad, double radius_m, double open_rad,
              double closed_rad)
        : center_(center),
          direction_rad_(direction_rad),
          radius_m_(radius_m),
          open_rad_(open_rad),
          closed_rad_(closed_rad) {}

    void add_crossing(const Vec2& point) {
        const Vec2 from_center = point - center_;
        const double distance_m = from_center.norm();
        if (distance_m < k_rounding_m || distance_m > radius_m_ + k_rounding_m) {
            return;
        }
        constexpr double k_rounding_rad = 1e-9;
        const double angle_rad = std::remainder(
            std::atan2(from_center.y(), from_center.x()) - direction_rad_, 2.0 * std::numbers::pi);
        if (angle_rad < open_rad_ - k_rounding_rad || angle_rad > closed_rad_ + k_rounding_rad ||
            (highest_rad_ && angle_rad >= *highest_rad_)) {
            return;
        }
        highest_rad_ = std::clamp(angle_rad, open_rad_, closed_rad_);
        distance_m_ = distance_m;
    }

    // Adds the point where the line from a to b leaves the disc.
    void add_leaving(const Vec2& a, const Vec2& b) {
        const Vec2 along = b - a;
        const double squared = along.squaredNorm();
        if (squared < k_rounding_m * k_rounding_m) {
            return;
        }
        const double middle = (center_ - a).dot(along) / squared;
        const Vec2 nearest = a + middle * along;
        const double half = radius_m_ * radius_m_ - (nearest - center_).squaredNorm();
        if (half < 0.0) {
            return;
        }
        for (const double side : {-1.0, 1.0}) {
            const double t = middle + side * std::sqrt(half / squared);
            if (t >= 0.0 && t <= 1.0) {
                add_crossing(a + t * along);
            }
        }
    }

    std::optional<double> highest_rad() const { return highest_rad_; }
    double distance_m() const { return distance_m_; }  // distance of the contact from the joint

  private:
    Vec2 center_;
    double direction_rad_;
    double radius_m_;
    double open_rad_;
    double closed_rad_;
    std::optional<double> highest_rad_;
    double distance_m_ = 0.0;
};

std::int32_t link_at(const HingeChain& chain, std::size_t joint, double distance_m) {
    std::size_t link = joint;
    while (link + 1 < chain.link_count && distance_m > chain.length_m[link]) {
        distance_m -= chain.length_m[link++];
    }
    return static_cast<std::int32_t>(link);
}

// Index of the first link, counted from `from`, that touches the mesh with these angles.
std::optional<std::size_t> first_touching_link(const HingeChain& chain, const ChainAngles& angles,
                                               std::size_t from, const GripMesh& mesh) {
    const auto capsules = chain_capsules(chain, angles);
    for (std::size_t i = from; i < chain.link_count; ++i) {
        const auto& [ends, radius_m] = capsules[i];
        const Vec3 middle = 0.5 * (ends[0] + ends[1]);
        if (mesh.contact_bvh.closest_point(middle, radius_m) ||
            mesh.contact_bvh.closest_point(ends[1], radius_m)) {
            return i;
        }
    }
    return std::nullopt;
}

}  // namespace

ClosedFinger close_on_crossings(const HingeChain& chain, std::span<const Vec2> line_ds) {
    ClosedFinger closed;
    Vec2 joint = Vec2::Zero();
    double direction_rad = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        JointDisc disc(joint, direction_rad, length_from(chain, i), chain.open_rad[i],
                       chain.closed_rad[i]);
        for (std::size_t k = 0; k < line_ds.size(); ++k) {
            disc.add_crossing(line_ds[k]);
            if (k > 0) {
                disc.add_leaving(line_ds[k - 1], line_ds[k]);
            }
        }
        if (disc.highest_rad()) {
            closed.contact_link =
                std::max(closed.contact_link, link_at(chain, i, disc.distance_m()));
        }
        closed.angle_rad[i] = disc.highest_rad().value_or(chain.closed_rad[i]);
        direction_rad += closed.angle_rad[i];
        joint += chain.length_m[i] * Vec2(std::cos(direction_rad), std::sin(direction_rad));
    }
    if (closed.contact_link == DiscClosure::k_none) {
        closed.angle_rad = chain.rest_rad;
    }
    return closed;
}

ClosedFinger close_by_talk(const HingeChain& chain, const GripMesh& mesh,
                           const GraphPoint& seed_under_palm, SearchOrder order,
                           ChainFitScratch& scratch) {
    ClosedFinger closed;
    closed.angle_rad = chain.rest_rad;
    closed.discs = 1;
    const Disc disc = disc_of(chain);
    const CrossingSearch found =
        find_crossing_in(order, mesh.search, disc, {&seed_under_palm, 1}, scratch.trace);
    closed.pops = found.pops;
    // Walks the surface that fingers touch. On the search detail, the comparison would be of
    // levels of detail instead of closing methods.
    const auto near = found.triangle != k_no_triangle
                          ? mesh.contact_bvh.closest_point(found.point, k_detail_apart_m)
                          : std::nullopt;
    if (!near) {
        return closed;
    }
    const GraphPoint contact_start = {near->triangle, near->point};
    const CrossingSearch onto =
        find_crossing(mesh.contact, disc, {&contact_start, 1}, scratch.trace);
    closed.walked = onto.pops;
    if (onto.triangle == k_no_triangle) {
        return closed;
    }
    scratch.segments.clear();  // unused: the walk's segments omit some of the crossings
    closed.walked +=
        walk_crossing(mesh.contact, disc, onto.triangle, scratch.trace, scratch.segments);
    const ClosedFinger flat = close_on_crossings(chain, scratch.trace.line);
    closed.angle_rad = flat.angle_rad;
    closed.contact_link = flat.contact_link;
    return closed;
}

ClosedFinger close_by_spheres(const HingeChain& chain, const GripMesh& mesh) {
    constexpr int k_steps = 50;
    ClosedFinger closed;
    closed.angle_rad = chain.open_rad;
    std::size_t moving = 0;  // first joint that still moves
    for (int step = 0; step <= k_steps; ++step) {
        const double share = static_cast<double>(step) / k_steps;
        while (moving < chain.link_count) {
            ChainAngles tried = closed.angle_rad;
            for (std::size_t i = moving; i < chain.link_count; ++i) {
                tried[i] = chain.open_rad[i] + share * (chain.closed_rad[i] - chain.open_rad[i]);
            }
            const auto touching = first_touching_link(chain, tried, moving, mesh);
            if (!touching) {
                closed.angle_rad = tried;
                break;
            }
            closed.contact_link = static_cast<std::int32_t>(*touching);
            moving = *touching + 1;
        }
    }
    if (closed.contact_link == DiscClosure::k_none) {
        closed.angle_rad = chain.rest_rad;
    }
    return closed;
}

}  // namespace handhold::lab
