#pragma once

#include <array>
#include <cstddef>

#include "engine/math/float4.hpp"

// How far four triangles are from a segment, in floats, side by side: what segment_triangle.hpp
// tells of one in doubles. For what only has to tell far from near.
namespace handhold {

// Of triangles about a segment's first end, the segment along the first axis. Squared. Never more
// than the distances, but for some roundings of the largest coordinate. Source: Ericson, Real-Time
// Collision Detection, section 5.1.9 (two segments).
class FourDistances {
  public:
    FourDistances(const FourCorners& corner, const FourFloats& length)
        : corner_(corner), length_(length) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                edge_[i][axis] = corner[(i + 1) % 3][axis] - corner[i][axis];
            }
        }
    }

    FourFloats squared() const {
        const FourFloats of_edges = lower(lower(to_edge(0), to_edge(1)), to_edge(2));
        return lower(of_edges, to_inside());
    }

  private:
    static FourFloats four(float value) { return FourFloats{value, value, value, value}; }
    static FourFloats size_of(const FourFloats& value) { return higher(value, -value); }
    // No less than the length.
    static FourFloats size_of(const FourVectors& v) {
        return size_of(v[0]) + size_of(v[1]) + size_of(v[2]);
    }
    FourFloats on_segment(const FourFloats& along) const {
        return lower(higher(along, FourFloats{}), length_);
    }

    // Where both are lines, then what of that is on the segment, on the edge, on the segment again.
    FourFloats to_edge(std::size_t i) const {
        const FourFloats tiny = four(1e-30F);
        const FourVectors& from = corner_[i];
        const FourVectors& edge = edge_[i];
        const FourFloats across = edge[1] * edge[1] + edge[2] * edge[2];
        const FourFloats beside = from[1] * edge[1] + from[2] * edge[2];
        const FourFloats met = on_segment(from[0] - beside / higher(across, tiny) * edge[0]);
        const FourFloats share =
            ((met - from[0]) * edge[0] - beside) / higher(across + edge[0] * edge[0], tiny);
        const FourFloats on_edge = lower(higher(share, FourFloats{}), four(1.0F));
        const FourFloats along = from[0] + on_edge * edge[0];
        const FourFloats x = along - on_segment(along);
        const FourFloats y = from[1] + on_edge * edge[1];
        const FourFloats z = from[2] + on_edge * edge[2];
        return x * x + y * y + z * z;
    }

    // Of the segment's ends over the triangle's inside; 0 where the segment goes through it. Where
    // a sliver's normal is not known well, less by what that may be.
    FourFloats to_inside() const {
        const FourFloats zero = {};
        const FourFloats far = four(1e30F);
        const FourVectors normal = cross(edge_[0], edge_[1]);
        const FourFloats squared_normal = dot(normal, normal);
        const FourFloats begin = -dot(normal, corner_[0]);
        const FourFloats rise = normal[0] * length_;
        const FourFloats end = begin + rise;
        const FourFloats spare =
            four(0x1p-20F) * size_of(edge_[0]) * size_of(edge_[1]) * size_of(corner_[0]);
        const FourInts goes_through = (begin > zero) ^ (end > zero);
        const FourFloats passage = -begin / (rise != zero ? rise : far) * length_;
        FourInts holds_begin = squared_normal > zero;
        FourInts holds_end = holds_begin;
        FourInts holds_passage = holds_begin & goes_through;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourVectors inward = cross(normal, edge_[i]);
            const FourFloats at_begin = -dot(inward, corner_[i]);
            holds_begin &= at_begin >= zero;
            holds_end &= at_begin + inward[0] * length_ >= zero;
            holds_passage &= at_begin + inward[0] * passage >= zero;
        }
        const FourFloats over_begin = higher(size_of(begin) - spare, zero);
        const FourFloats over_end = higher(size_of(end) - spare, zero);
        const FourFloats over = lower(holds_begin ? over_begin : far, holds_end ? over_end : far);
        const FourFloats clear = over < far ? over * over / squared_normal : far;
        return holds_passage ? zero : clear;
    }

    const FourCorners& corner_;
    const FourFloats& length_;
    std::array<FourVectors, 3> edge_ = {};
};

}  // namespace handhold
