#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// A planar chain of hinged links that closes until it touches segments.
//
// Disc space (_ds): the first hinge is the origin, +X is the first link's direction at angle 0, and
// positive angles turn from +X towards +Y; metres, radians. Sources: talk rows 12 to 14. Contact
// times come from conservative advancement (Mirtich 1996, "Impulse-based Dynamic Simulation",
// section 2.3), distances from Box2D's GJK (disc_contact_box2d.cpp).
namespace handhold {

inline constexpr std::size_t k_max_disc_links = 3;
inline constexpr std::size_t k_disc_planes = 3;

// Intersection of a surface with one of the parallel planes that cut the chain.
struct DiscSegment {
    Vec2 a_ds = Vec2::Zero();
    Vec2 b_ds = Vec2::Zero();
    std::uint32_t plane = 0;     // < k_disc_planes
    std::uint32_t triangle = 0;  // set by the caller; not used here
};

// Link i lies between hinge i and the next one. While the chain closes, every hinge i turns from
// open_rad[i] to closed_rad[i] at the same fraction.
struct DiscChain {
    std::uint32_t link_count = 3;  // 1 to k_max_disc_links
    std::array<double, k_max_disc_links> length_m = {};
    // Half thickness of each link in each plane. A plane beside the axis of a round link cuts a
    // thinner section. Negative: the plane misses the link.
    std::array<std::array<double, k_max_disc_links>, k_disc_planes> radius_m = {};
    std::array<double, k_max_disc_links> open_rad = {};
    std::array<double, k_max_disc_links> closed_rad = {};
};

struct DiscClosure {
    static constexpr std::int32_t k_none = -1;
    std::array<double, k_max_disc_links> angle_rad = {};
    std::int32_t contact_link = k_none;  // last link that touches
    std::uint32_t touching = 0;          // bit i: link i touches
    std::uint32_t segment = 0;           // segment of the last contact; valid if a link touches
    std::uint32_t distances = 0;         // number of GJK distance queries
};

// Range of the closing fraction: 0 is fully open, 1 is fully closed.
struct DiscSweep {
    double from = 0.0;
    double to = 1.0;
};

// Working memory, reused between calls.
struct DiscScratch {
    struct Pair {
        double next = 0.0;  // earliest closing fraction at which the pair may touch
        double separation_m = 0.0;
        std::uint32_t link = 0;
        std::uint32_t segment = 0;
        // The pair overlapped when first queried and is moving apart. It is ignored until it is
        // clear.
        bool leaving = false;
        bool seen = false;
    };
    // Bounding boxes of four segments: [axis][segment].
    struct Bounds4 {
        std::array<Float4, 2> low = {};
        std::array<Float4, 2> high = {};
    };
    std::vector<Pair> pairs;  // pairs whose swept bounds came near each other
    std::vector<std::uint32_t>
        paired;                   // one per segment; bit i: the pair with link i is in `pairs`
    std::vector<Bounds4> bounds;  // one per four segments; the last segment is repeated
};

// Largest error of a contact; the tests hold it.
inline constexpr double k_disc_accuracy_m = 5e-5;

// Closes the chain from `sweep.from` to at most `sweep.to`. A link that touches stops its own hinge
// and all hinges before it. The links beyond it go on closing until they touch or the sweep ends. A
// link that overlaps a segment at the start and moves out of it is ignored until it is clear.
// Misses no contact and finds each within k_disc_accuracy_m. Does not allocate once the scratch
// memory has grown.
DiscClosure close_chain(const DiscChain& chain, std::span<const DiscSegment> segments,
                        const DiscSweep& sweep, DiscScratch& scratch);

// Distance between two segments, metres; 0 if they cross. Error at most 5e-7 m for coordinates
// below 1 m.
double disc_distance(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1);

}  // namespace handhold
