#include "engine/geometry/hinge_chain.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

Vec3 from_disc(const Pose& base, const Vec2& point_ds) {
    return base.position + base.rotation * Vec3(0.0, -point_ds.y(), -point_ds.x());
}

// Bounding box of the unit circle's arc between two angles.
ReachBox arc_box(double from_rad, double to_rad) {
    constexpr double k_piece_rad = 0.5;
    const int pieces = 2 + static_cast<int>((to_rad - from_rad) / k_piece_rad);
    const double piece_rad = (to_rad - from_rad) / pieces;
    ReachBox box = {Vec2::Constant(1.0), Vec2::Constant(-1.0)};
    for (int i = 0; i <= pieces; ++i) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(from_rad + i * piece_rad, sine, cosine);
        box.low = box.low.cwiseMin(Vec2(cosine, sine));
        box.high = box.high.cwiseMax(Vec2(cosine, sine));
    }
    // Sagitta: largest distance of an arc from its chord.
    const double bulge = piece_rad * piece_rad / 8.0;
    box.low.array() -= bulge;
    box.high.array() += bulge;
    return box;
}

}  // namespace

std::array<Capsule, k_max_disc_links> chain_capsules(const HingeChain& chain,
                                                     const ChainAngles& angle_rad) {
    const auto points_ds = chain_points_ds(chain, angle_rad);
    std::array<Capsule, k_max_disc_links> capsules;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        capsules[i] = {
            {from_disc(chain.base, points_ds[i]), from_disc(chain.base, points_ds[i + 1])},
            chain.radius_m[i]};
    }
    return capsules;
}

std::array<Vec2, k_max_disc_links + 1> chain_points_ds(const HingeChain& chain,
                                                       const ChainAngles& angle_rad) {
    std::array<Vec2, k_max_disc_links + 1> points;
    points[0] = Vec2::Zero();
    double angle = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        angle += angle_rad[i];
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(angle, sine, cosine);
        points[i + 1] = points[i] + chain.length_m[i] * Vec2(cosine, sine);
    }
    return points;
}

double max_radius_m(const HingeChain& chain) {
    double radius_m = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        radius_m = std::max(radius_m, chain.radius_m[i]);
    }
    return radius_m;
}

double reach_m(const HingeChain& chain) {
    double reach = max_radius_m(chain);
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        reach += chain.length_m[i];
    }
    return reach;
}

double plane_offset_m(const HingeChain& chain, double plane_offset, std::size_t plane) {
    double mean = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        mean += chain.radius_m[i] / chain.link_count;
    }
    constexpr std::array<double, k_disc_planes> k_places = {0.0, 1.0, -1.0};
    return k_places[plane] * plane_offset * mean;
}

double half_width_m(const HingeChain& chain, double plane_offset) {
    return std::max(max_radius_m(chain), plane_offset_m(chain, plane_offset, 1));
}

ChainReach chain_reach(const HingeChain& chain, const ChainAngles& min_rad,
                       const ChainAngles& max_rad) {
    ChainReach reach = {chain.base, reach_m(chain), max_radius_m(chain)};
    ReachBox hinge = {Vec2::Zero(), Vec2::Zero()};
    std::array<double, 2> turn_rad = {};
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        turn_rad[0] += min_rad[i];
        turn_rad[1] += max_rad[i];
        const ReachBox link = arc_box(turn_rad[0], turn_rad[1]);
        const ReachBox next = {hinge.low + chain.length_m[i] * link.low,
                               hinge.high + chain.length_m[i] * link.high};
        reach.boxes[i].low = hinge.low.cwiseMin(next.low).array() - chain.radius_m[i];
        reach.boxes[i].high = hinge.high.cwiseMax(next.high).array() + chain.radius_m[i];
        hinge = next;
    }
    reach.box_count = chain.link_count;
    return reach;
}

ChainAngles lowest(const ChainAngles& a, const ChainAngles& b) {
    ChainAngles low = a;
    for (std::size_t i = 0; i < low.size(); ++i) {
        low[i] = std::min(a[i], b[i]);
    }
    return low;
}

ChainAngles highest(const ChainAngles& a, const ChainAngles& b) {
    ChainAngles high = a;
    for (std::size_t i = 0; i < high.size(); ++i) {
        high[i] = std::max(a[i], b[i]);
    }
    return high;
}

DiscChain flat_chain(const HingeChain& chain, double plane_offset) {
    DiscChain flat;
    flat.link_count = chain.link_count;
    flat.length_m = chain.length_m;
    flat.open_rad = chain.open_rad;
    flat.closed_rad = chain.closed_rad;
    for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
        const double offset = plane_offset_m(chain, plane_offset, plane);
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            const double squared = chain.radius_m[i] * chain.radius_m[i] - offset * offset;
            flat.radius_m[plane][i] = squared > 0.0 ? std::sqrt(squared) : -1.0;
        }
    }
    return flat;
}

ChainDepth chain_depth(const HingeChain& chain, const ChainAngles& angle_rad, ChainPatch& patch,
                       const DepthQuery& query) {
    ChainDepth deepest;
    const auto points_ds = chain_points_ds(chain, angle_rad);
    const std::size_t end = std::min<std::size_t>(chain.link_count, query.end);
    for (std::size_t i = query.first; i < end; ++i) {
        const CapsulePenetration penetration =
            patch.find_penetration({points_ds[i], points_ds[i + 1]}, chain.radius_m[i], i);
        double depth_m = penetration.depth_m;
        if (penetration.crossed_at) {
            deepest.is_crossed = true;
            depth_m += (1.0 - *penetration.crossed_at) * chain.length_m[i];
            for (std::size_t rest = i + 1; rest < chain.link_count; ++rest) {
                depth_m += chain.length_m[rest];
            }
        }
        if (depth_m > deepest.depth_m) {
            deepest.depth_m = depth_m;
            deepest.link = i;
        }
        if (penetration.crossed_at || deepest.depth_m >= query.sufficient_depth_m) {
            break;
        }
    }
    return deepest;
}

double posed_depth_m(const HingeChain& chain, const ChainAngles& angle_rad,
                     std::span<const PlacedMesh> meshes, ChainPatch& patch) {
    patch.gather(chain_reach(chain, angle_rad, angle_rad), meshes);
    return chain_depth(chain, angle_rad, patch).depth_m;
}

double ChainDepths::depth_m(const ChainAngles& angle_rad, double sufficient_depth_m) {
    const FirstLink& first = first_link(angle_rad);
    if (first.is_crossed || first.depth_m >= sufficient_depth_m) {
        return first.depth_m;
    }
    const ChainDepth others = chain_depth(chain_, angle_rad, patch_,
                                          {.first = 1, .sufficient_depth_m = sufficient_depth_m});
    return std::max(first.depth_m, others.depth_m);
}

const ChainDepths::FirstLink& ChainDepths::first_link(const ChainAngles& angle_rad) {
    for (std::size_t i = 0; i < known_count_; ++i) {
        if (known_[i].angle_rad == angle_rad[0]) {
            return known_[i];
        }
    }
    const ChainDepth depth = chain_depth(chain_, angle_rad, patch_, {.end = 1});
    known_count_ = std::min(known_count_ + 1, known_.size());
    return known_[known_count_ - 1] = {angle_rad[0], depth.depth_m, depth.is_crossed};
}

}  // namespace handhold
