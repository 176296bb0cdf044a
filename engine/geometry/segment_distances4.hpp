#pragma once

#include <array>
#include <cstddef>

#include "engine/math/float4.hpp"

// Distances of four triangles from a segment, in floats. SIMD counterpart of segment_triangle.hpp,
// for rejection tests.
namespace handhold {

// The triangles are given relative to the segment's first end, with the segment along the first
// axis. Results are squared and never exceed the true distances by more than a few roundings of the
// largest coordinate. Source: Ericson, Real-Time Collision Detection, section 5.1.9 (two segments).
class SegmentDistances4 {
  public:
    SegmentDistances4(const Corners4& corner, const Float4& length)
        : corner_(corner), length_(length) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                edge_[i][axis] = corner[(i + 1) % 3][axis] - corner[i][axis];
            }
        }
    }

    Float4 squared() const {
        const Float4 of_edges = lower(lower(to_edge(0), to_edge(1)), to_edge(2));
        return lower(of_edges, to_inside());
    }

  private:
    static Float4 splat(float value) { return Float4{value, value, value, value}; }
    static Float4 abs_of(const Float4& value) { return higher(value, -value); }
    // Upper bound on the length (1-norm).
    static Float4 abs_of(const Vectors4& v) { return abs_of(v[0]) + abs_of(v[1]) + abs_of(v[2]); }
    Float4 on_segment(const Float4& along) const { return lower(higher(along, Float4{}), length_); }

    // Squared distance between the segment and edge i. Starts with the closest points of their
    // lines. Then the point on the segment is clamped to it, then the point on the edge, then the
    // point on the segment again.
    Float4 to_edge(std::size_t i) const {
        const Float4 tiny = splat(1e-30F);
        const Vectors4& from = corner_[i];
        const Vectors4& edge = edge_[i];
        const Float4 across = edge[1] * edge[1] + edge[2] * edge[2];
        const Float4 beside = from[1] * edge[1] + from[2] * edge[2];
        const Float4 met = on_segment(from[0] - beside / higher(across, tiny) * edge[0]);
        const Float4 share =
            ((met - from[0]) * edge[0] - beside) / higher(across + edge[0] * edge[0], tiny);
        const Float4 on_edge = lower(higher(share, Float4{}), splat(1.0F));
        const Float4 along = from[0] + on_edge * edge[0];
        const Float4 x = along - on_segment(along);
        const Float4 y = from[1] + on_edge * edge[1];
        const Float4 z = from[2] + on_edge * edge[2];
        return x * x + y * y + z * z;
    }

    // Squared distance from the segment's ends to the triangle's interior; 0 if the segment crosses
    // the triangle. The distance is reduced by the error of a sliver's inexact normal.
    Float4 to_inside() const {
        const Float4 zero = {};
        const Float4 far = splat(1e30F);
        const Vectors4 normal = cross(edge_[0], edge_[1]);
        const Float4 squared_normal = dot(normal, normal);
        const Float4 begin = -dot(normal, corner_[0]);
        const Float4 rise = normal[0] * length_;
        const Float4 end = begin + rise;
        const Float4 margin =
            splat(0x1p-20F) * abs_of(edge_[0]) * abs_of(edge_[1]) * abs_of(corner_[0]);
        const Int4 goes_through = (begin > zero) ^ (end > zero);
        const Float4 passage = -begin / (rise != zero ? rise : far) * length_;
        Int4 holds_begin = squared_normal > zero;
        Int4 holds_end = holds_begin;
        Int4 holds_passage = holds_begin & goes_through;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vectors4 inward = cross(normal, edge_[i]);
            const Float4 at_begin = -dot(inward, corner_[i]);
            holds_begin &= at_begin >= zero;
            holds_end &= at_begin + inward[0] * length_ >= zero;
            holds_passage &= at_begin + inward[0] * passage >= zero;
        }
        const Float4 over_begin = higher(abs_of(begin) - margin, zero);
        const Float4 over_end = higher(abs_of(end) - margin, zero);
        const Float4 over = lower(holds_begin ? over_begin : far, holds_end ? over_end : far);
        const Float4 clear = over < far ? over * over / squared_normal : far;
        return holds_passage ? zero : clear;
    }

    const Corners4& corner_;
    const Float4& length_;
    std::array<Vectors4, 3> edge_ = {};
};

}  // namespace handhold
