#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "engine/geometry/disc_contact.hpp"
#include "tests/engine/collision/scene.hpp"

// Distances in the plane in closed form, in double precision, and chains replayed in small steps:
// nothing of the code under test.
namespace handhold::test {

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

inline double point_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (point - a - t * along).norm();
}

// Zero where they cross; else one of the four ends is nearest.
inline double exact_distance(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) {
    const bool b_on_both_sides = cross(a1 - a0, b0 - a0) * cross(a1 - a0, b1 - a0) < 0.0;
    const bool a_on_both_sides = cross(b1 - b0, a0 - b0) * cross(b1 - b0, a1 - b0) < 0.0;
    if (a_on_both_sides && b_on_both_sides) {
        return 0.0;
    }
    return std::min({point_to_segment(a0, b0, b1), point_to_segment(a1, b0, b1),
                     point_to_segment(b0, a0, a1), point_to_segment(b1, a0, a1)});
}

// A chain on its way: hinges before first_free_hinge stay, the others go on together.
struct ClosingOracle {
    const DiscChain& chain;
    std::array<double, k_max_disc_links> kept_rad = {};
    std::size_t first_free_hinge = 0;

    std::array<Vec2, k_max_disc_links + 1> points_at(double at) const {
        std::array<Vec2, k_max_disc_links + 1> points;
        points[0] = Vec2::Zero();
        double angle = 0.0;
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            angle += i < first_free_hinge
                         ? kept_rad[i]
                         : chain.open_rad[i] + at * (chain.closed_rad[i] - chain.open_rad[i]);
            points[i + 1] = points[i] + chain.length_m[i] * Vec2(std::cos(angle), std::sin(angle));
        }
        return points;
    }

    // Infinite where the plane misses the link.
    double separation_m(std::size_t link, const DiscSegment& segment, double at) const {
        const double radius_m = chain.radius_m[segment.plane][link];
        if (radius_m < 0.0) {
            return std::numeric_limits<double>::infinity();
        }
        const auto points = points_at(at);
        return exact_distance(points[link], points[link + 1], segment.a_ds, segment.b_ds) -
               radius_m;
    }

    double least_separation_m(std::span<const DiscSegment> segments, double at) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t link = first_free_hinge; link < chain.link_count; ++link) {
            for (const DiscSegment& segment : segments) {
                least = std::min(least, separation_m(link, segment, at));
            }
        }
        return least;
    }
};

inline DiscChain random_chain(Random& random) {
    DiscChain chain;
    chain.link_count = 1 + static_cast<std::uint32_t>(random.between(0.0, 2.999));
    for (std::size_t i = 0; i < k_max_disc_links; ++i) {
        chain.length_m[i] = random.between(0.012, 0.06);
        chain.open_rad[i] = random.between(-0.4, 0.1);
        chain.closed_rad[i] = chain.open_rad[i] + random.between(0.4, 2.3);
        const double radius_m = random.between(0.004, 0.013);
        chain.radius_m[0][i] = radius_m;
        chain.radius_m[1][i] = 0.78 * radius_m;
        chain.radius_m[2][i] = random.between(0.0, 1.0) < 0.1 ? -1.0 : 0.78 * radius_m;
    }
    return chain;
}

// Anywhere in reach, from slivers of a tenth of a millimetre to 6 cm.
inline DiscSegment random_segment(Random& random) {
    const double turn = random.between(-3.14159, 3.14159);
    const double length_m = 1e-4 * std::pow(600.0, random.between(0.0, 1.0));
    DiscSegment segment;
    segment.a_ds = {random.between(-0.05, 0.15), random.between(-0.05, 0.15)};
    segment.b_ds = segment.a_ds + length_m * Vec2(std::cos(turn), std::sin(turn));
    segment.plane = static_cast<std::uint32_t>(random.between(0.0, 2.999));
    return segment;
}

// None of them nearer to the open chain than clear_m.
inline std::vector<DiscSegment> random_clear_segments(const DiscChain& chain, double clear_m,
                                                      Random& random) {
    const ClosingOracle open{chain};
    std::vector<DiscSegment> segments;
    const double count = random.between(1.0, 9.0);
    while (static_cast<double>(segments.size()) < count) {
        const DiscSegment segment = random_segment(random);
        if (open.least_separation_m({&segment, 1}, 0.0) > clear_m) {
            segments.push_back(segment);
        }
    }
    return segments;
}

}  // namespace handhold::test
