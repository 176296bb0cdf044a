#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// A chain of hinged links that closes in a plane until it touches: the 2D half of a finger.
//
// Disc space (_ds): the first hinge at the origin, +X along the first link at angle 0, positive
// angles turn from +X towards +Y; metres, radians. Sources: talk rows 12 to 14; conservative
// advancement after Mirtich 1996 ("Impulse-based Dynamic Simulation", section 2.3), distances by
// Box2D's GJK (disc_contact_box2d.cpp).
namespace handhold {

inline constexpr std::size_t k_max_disc_links = 3;
inline constexpr std::size_t k_disc_planes = 3;

// A piece of a surface cut by one of the parallel planes that a chain with thickness is cut by.
struct DiscSegment {
    Vec2 a_ds = Vec2::Zero();
    Vec2 b_ds = Vec2::Zero();
    std::uint32_t plane = 0;     // < k_disc_planes
    std::uint32_t triangle = 0;  // where it comes from: the caller's, given back with a contact
};

// Link i lies between hinge i and the next one; while the chain closes, the angle of hinge i goes
// from open_rad[i] to closed_rad[i], all hinges in step.
struct DiscChain {
    std::uint32_t link_count = 3;  // 1 to k_max_disc_links
    std::array<double, k_max_disc_links> length_m = {};
    // Half thickness of each link where each plane cuts it: a plane beside a round link's middle
    // cuts it thinner. Negative: the plane misses the link.
    std::array<std::array<double, k_max_disc_links>, k_disc_planes> radius_m = {};
    std::array<double, k_max_disc_links> open_rad = {};
    std::array<double, k_max_disc_links> closed_rad = {};
};

struct DiscClosure {
    static constexpr std::int32_t k_none = -1;
    std::array<double, k_max_disc_links> angle_rad = {};
    std::int32_t contact_link = k_none;  // the last link that touches
    std::uint32_t touching = 0;          // bit i: link i touches
    std::uint32_t segment = 0;           // the last contact's, where there is one
    std::uint32_t distances = 0;         // distance queries that were needed
};

// How far the closing goes, and where from.
struct DiscSweep {
    double from = 0.0;  // 0: fully open, 1: fully closed
    double to = 1.0;
};

// What a call needs beside its result: keeps its memory between calls.
struct DiscScratch {
    struct Pair {
        double next = 0.0;  // no contact before
        double separation_m = 0.0;
        std::uint32_t link = 0;
        std::uint32_t segment = 0;
        bool leaving = false;  // overlapped when its turn came, and comes apart: ignored until then
        bool seen = false;
    };
    // Around four segments, by axis.
    struct Bounds4 {
        std::array<Float4, 2> low = {};
        std::array<Float4, 2> high = {};
    };
    std::vector<Pair> pairs;            // that came near
    std::vector<std::uint32_t> paired;  // by segment, a bit for each link: is in `pairs`
    std::vector<Bounds4> bounds;        // four segments each, the last repeated
};

// Closes the chain from `sweep.from` on. The first link that touches stops its hinge and those
// before it; the links beyond go on closing, until they touch too or sweep.to is reached. Links
// that overlap a segment at first and move out of it are let go until they are clear. A contact is
// found within 0.05 mm, none is missed. No allocation once scratch has grown.
DiscClosure close_chain(const DiscChain& chain, std::span<const DiscSegment> segments,
                        const DiscSweep& sweep, DiscScratch& scratch);

// Distance between two segments, metres; 0 where they cross. Within 5e-7 m for coordinates below
// 1 m.
double disc_distance(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1);

}  // namespace handhold
