#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/disc_contact.hpp"
#include "engine/math/math.hpp"

// Distance between a link and a segment, for disc_contact.cpp only. Inline because it runs in the
// inner loop.
namespace handhold {

inline double disc_cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Nearest points of a link and a segment in disc space, in closed form.
struct DiscGap {
    double distance_m = 0.0;
    Vec2 on_segment = Vec2::Zero();
    Vec2 away = Vec2::Zero();  // unit, from the segment to the link; zero if they cross
};

class DiscGapFinder {
  public:
    DiscGap run(const Vec2& begin, const Vec2& end, const DiscSegment& segment) {
        const Vec2 link = end - begin;
        const Vec2 along = segment.b_ds - segment.a_ds;
        const Vec2 from_a = begin - segment.a_ds;
        const double begin_side = disc_cross(along, from_a);
        const double end_side = begin_side + disc_cross(along, link);
        const double a_side = -disc_cross(link, from_a);
        const double b_side = a_side + disc_cross(link, along);
        if ((begin_side > 0.0) != (end_side > 0.0) && (a_side > 0.0) != (b_side > 0.0)) {
            return {};
        }
        const double link2 = link.squaredNorm();
        const double along2 = along.squaredNorm();
        take_on_segment(begin, segment.a_ds, along, along2);
        take_on_segment(end, segment.a_ds, along, along2);
        take_on_link(segment.a_ds, begin, link, link2);
        take_on_link(segment.b_ds, begin, link, link2);
        const double distance_m = std::sqrt(squared_);
        return {distance_m, on_segment_,
                distance_m > 0.0 ? Vec2((on_link_ - on_segment_) / distance_m) : Vec2::Zero()};
    }

  private:
    static Vec2 projected(const Vec2& point, const Vec2& from, const Vec2& along, double squared) {
        return squared > 0.0
                   ? Vec2(from + std::clamp((point - from).dot(along) / squared, 0.0, 1.0) * along)
                   : from;
    }
    void take(const Vec2& on_link, const Vec2& on_segment) {
        const double squared = (on_link - on_segment).squaredNorm();
        if (squared < squared_) {
            squared_ = squared;
            on_link_ = on_link;
            on_segment_ = on_segment;
        }
    }
    void take_on_segment(const Vec2& link_end, const Vec2& from, const Vec2& along,
                         double squared) {
        take(link_end, projected(link_end, from, along, squared));
    }
    void take_on_link(const Vec2& corner, const Vec2& from, const Vec2& along, double squared) {
        take(projected(corner, from, along, squared), corner);
    }

    double squared_ = std::numeric_limits<double>::infinity();
    Vec2 on_link_ = Vec2::Zero();
    Vec2 on_segment_ = Vec2::Zero();
};

}  // namespace handhold
