#include "engine/geometry/disc_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr double k_disc_touch_m = 2e-5;  // nearer counts as touching
constexpr double k_aim_m = 1e-5;         // so near an advance may come: less than touching, so that
                                         // what comes near stops there at once
constexpr double k_disc_clear_m = 1e-4;  // what left an overlap by this much can touch again
constexpr double k_surely_apart_m = 3e-5;  // from here on the closed form does: Box2D, which has
                                           // the last word about touches, is 5e-7 m off at most
constexpr int k_most_rounds = 20000;       // a guard: a few dozen are usual
constexpr double k_leave_step = 1.0 / 64.0;
constexpr double k_leave_noise_m = 1e-6;

using Points = std::array<Vec2, k_most_disc_links + 1>;

// The hinges, and the last link's end.
struct ChainMotion {
    Points point;
    Points velocity_m;  // for the whole closing
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Where the links are while those before `first_free` keep their angles.
class ClosingChain {
  public:
    ClosingChain(const DiscChain& chain, double at) : chain_(chain) {
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
        look_ahead();
    }

    double angle_at(std::size_t hinge, double at) const {
        return chain_.open_rad[hinge] + at * (chain_.closed_rad[hinge] - chain_.open_rad[hinge]);
    }

    ChainMotion motion_at(double at) const {
        ChainMotion motion;
        for (std::size_t i = 0; i <= first_free_; ++i) {
            motion.point[i] = kept_point_[i];
            motion.velocity_m[i] = Vec2::Zero();
        }
        double angle = kept_angle_rad_;
        for (std::size_t i = first_free_; i < chain_.link_count; ++i) {
            angle += angle_at(i, at);
            const Vec2 way = chain_.length_m[i] * direction(angle);
            motion.point[i + 1] = motion.point[i] + way;
            motion.velocity_m[i + 1] =
                motion.velocity_m[i] + turn_rad_[i] * Vec2(-way.y(), way.x());
        }
        return motion;
    }

    // No point `i` of the motion is accelerated more, metres for the whole closing, squared.
    double acceleration_m(std::size_t point) const { return acceleration_m_[point]; }

    // Hinges up to and with `last` keep the angles they have at `at`.
    void freeze(std::size_t last, double at) {
        for (std::size_t i = first_free_; i <= last; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
        first_free_ = last + 1;
        look_ahead();
    }

    std::size_t first_free() const { return first_free_; }
    const std::array<double, k_most_disc_links>& angle_rad() const { return angle_rad_; }

  private:
    static Vec2 direction(double angle) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(angle, sine, cosine);
        return {cosine, sine};
    }

    // What stays the same until the next hinge is frozen.
    void look_ahead() {
        kept_angle_rad_ = 0.0;
        kept_point_[0] = Vec2::Zero();
        for (std::size_t i = 0; i < first_free_; ++i) {
            kept_angle_rad_ += angle_rad_[i];
            kept_point_[i + 1] = kept_point_[i] + chain_.length_m[i] * direction(kept_angle_rad_);
        }
        acceleration_m_.fill(0.0);
        double turn_rad = 0.0;
        for (std::size_t i = first_free_; i < chain_.link_count; ++i) {
            turn_rad += chain_.closed_rad[i] - chain_.open_rad[i];
            turn_rad_[i] = turn_rad;
            acceleration_m_[i + 1] = acceleration_m_[i] + turn_rad * turn_rad * chain_.length_m[i];
        }
    }

    const DiscChain& chain_;
    std::array<double, k_most_disc_links> angle_rad_ = {};
    std::size_t first_free_ = 0;
    double kept_angle_rad_ = 0.0;  // of the last link that is kept
    Points kept_point_;
    std::array<double, k_most_disc_links> turn_rad_ = {};  // of each link, for the whole closing
    std::array<double, k_most_disc_links + 1> acceleration_m_ = {};
};

// Where two segments are nearest to each other, in closed form.
struct Gap {
    double distance_m = 0.0;
    Vec2 on_segment = Vec2::Zero();
    Vec2 away = Vec2::Zero();  // unit, from the segment to the link; zero where they cross
};

class NearestPair {
  public:
    Gap run(const Vec2& begin, const Vec2& end, const DiscSegment& segment) {
        const Vec2 link = end - begin;
        const Vec2 along = segment.b_ds - segment.a_ds;
        const Vec2 from_a = begin - segment.a_ds;
        const double begin_side = cross(along, from_a);
        const double end_side = begin_side + cross(along, link);
        const double a_side = -cross(link, from_a);
        const double b_side = a_side + cross(link, along);
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
    static Vec2 foot(const Vec2& point, const Vec2& from, const Vec2& along, double squared) {
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
        take(link_end, foot(link_end, from, along, squared));
    }
    void take_on_link(const Vec2& corner, const Vec2& from, const Vec2& along, double squared) {
        take(foot(corner, from, along, squared), corner);
    }

    double squared_ = std::numeric_limits<double>::infinity();
    Vec2 on_link_ = Vec2::Zero();
    Vec2 on_segment_ = Vec2::Zero();
};

// A box around points.
struct DiscBox {
    Vec2 low = Vec2::Zero();
    Vec2 high = Vec2::Zero();

    DiscBox() = default;
    DiscBox(const Vec2& a, const Vec2& b) : low(a.cwiseMin(b)), high(a.cwiseMax(b)) {}

    void add(const DiscBox& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
    bool is_within(double distance_m, const DiscBox& other) const {
        return low.x() - other.high.x() <= distance_m && other.low.x() - high.x() <= distance_m &&
               low.y() - other.high.y() <= distance_m && other.low.y() - high.y() <= distance_m;
    }
};

// The first time at which a point may have come nearer by `room_m`, from now: it approaches at
// `speed_m` now, and its speed changes by no more than `acceleration_m`.
double time_to_cross(double room_m, double speed_m, double acceleration_m) {
    const double root = std::sqrt(speed_m * speed_m + 2.0 * acceleration_m * room_m);
    if (speed_m > 0.0) {
        return 2.0 * room_m / (speed_m + root);
    }
    return acceleration_m > 0.0 ? (root - speed_m) / acceleration_m
                                : std::numeric_limits<double>::infinity();
}

struct Touch {
    double at = 0.0;
    std::size_t link = 0;
    std::uint32_t segment = 0;

    bool operator<(const Touch& other) const {
        return std::tie(at, link, segment) < std::tie(other.at, other.link, other.segment);
    }
};

class Closing {
  public:
    Closing(const DiscChain& chain, std::span<const DiscSegment> segments, const DiscSweep& sweep,
            DiscScratch& scratch)
        : chain_(chain),
          segments_(segments),
          sweep_(sweep),
          scratch_(scratch),
          pairs_(scratch.pairs),
          links_(chain, sweep.from) {
        look_at_segments();
    }

    DiscClosure run() {
        double at = sweep_.from;
        while (links_.first_free() < chain_.link_count) {
            const std::optional<Touch> touch = first_touch(at);
            if (!touch) {
                links_.freeze(chain_.link_count - 1, sweep_.to);
                break;
            }
            at = touch->at;
            links_.freeze(touch->link, at);
            closure_.contact_link = static_cast<std::int32_t>(touch->link);
            closure_.touching |= 1U << touch->link;
            closure_.segment = touch->segment;
        }
        closure_.angle_rad = links_.angle_rad();
        return closure_;
    }

  private:
    using Pair = DiscScratch::Pair;

    // None is paired yet; bounds around all segments.
    void look_at_segments() {
        for (std::size_t link = 0; link < chain_.link_count; ++link) {
            for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
                thickest_m_[link] = std::max(thickest_m_[link], chain_.radius_m[plane][link]);
            }
        }
        scratch_.bounds.resize((segments_.size() + 3) / 4);
        for (std::size_t i = 0; i < 4 * scratch_.bounds.size(); ++i) {
            const DiscSegment& segment = segments_[std::min(i, segments_.size() - 1)];
            DiscScratch::FourBounds& bounds = scratch_.bounds[i / 4];
            for (std::size_t axis = 0; axis < 2; ++axis) {
                const auto along = static_cast<Eigen::Index>(axis);
                const auto a = static_cast<float>(segment.a_ds[along]);
                const auto b = static_cast<float>(segment.b_ds[along]);
                bounds.low[axis][i % 4] = std::min(a, b);
                bounds.high[axis][i % 4] = std::max(a, b);
            }
        }
    }

    double radius_m(const Pair& pair) const {
        return chain_.radius_m[segments_[pair.segment].plane][pair.link];
    }

    Gap gap_of(const Pair& pair, const ChainMotion& motion) const {
        return NearestPair().run(motion.point[pair.link], motion.point[pair.link + 1],
                                 segments_[pair.segment]);
    }

    // Until then a line between the two stays clear of both: the segment is behind it, and each of
    // the link's ends needs so long to come to it.
    double next_touch(const Pair& pair, const Gap& gap, double free_m, const ChainMotion& motion,
                      double at) const {
        double step = std::numeric_limits<double>::infinity();
        for (std::size_t end = pair.link; end <= pair.link + 1; ++end) {
            const double beyond_m =
                gap.away.dot(motion.point[end] - gap.on_segment) - gap.distance_m;
            step = std::min(step, time_to_cross(std::max(beyond_m, 0.0) + free_m - k_aim_m,
                                                -gap.away.dot(motion.velocity_m[end]),
                                                links_.acceleration_m(end)));
        }
        return at + step;
    }

    // Stretch by stretch: of most pairs, boxes around their ways tell that they stay apart.
    std::optional<Touch> first_touch(double from) {
        constexpr double k_stretch = 1.0 / 8.0;
        pairs_.clear();
        scratch_.paired.assign(segments_.size(), 0);
        ChainMotion before = links_.motion_at(from);
        double at = from;
        for (;;) {
            const double end = std::min(at + k_stretch, sweep_.to);
            const ChainMotion after = links_.motion_at(end);
            const Ways ways = ways_of(before, after, end - at);
            const std::size_t near = find_near(ways, end);
            const std::size_t known = pairs_.size();
            add_near(ways, at, at > from);
            const std::optional<Touch> touch =
                first_touch_of(bring_to_front(near, known), from, end);
            if (touch || end >= sweep_.to) {
                return touch;
            }
            at = end;
            before = after;
        }
    }

    // Where the links pass in one stretch.
    struct Ways {
        std::array<DiscBox, k_most_disc_links> box;
        std::array<double, k_most_disc_links> bulge_m = {};  // of the way beyond the box
    };
    Ways ways_of(const ChainMotion& before, const ChainMotion& after, double length) const {
        Ways ways;
        for (std::size_t link = links_.first_free(); link < chain_.link_count; ++link) {
            ways.box[link] = {before.point[link], before.point[link + 1]};
            ways.box[link].add({after.point[link], after.point[link + 1]});
            ways.bulge_m[link] = links_.acceleration_m(link + 1) * length * length / 8.0;
        }
        return ways;
    }

    bool may_touch(const Ways& ways, std::size_t link, std::uint32_t i) const {
        const DiscSegment& segment = segments_[i];
        const double reach_m =
            chain_.radius_m[segment.plane][link] + k_disc_touch_m + ways.bulge_m[link];
        return ways.box[link].is_within(reach_m, {segment.a_ds, segment.b_ds});
    }

    // Pairs that come near in this stretch for the first time. Those that never do, which are most,
    // cost no more than a look at the segment's bounds.
    void add_near(const Ways& ways, double at, bool is_later) {
        constexpr double k_rounding_m = 1e-5;  // of floats below 50 m; fingers are decimetres
        for (std::size_t link = links_.first_free(); link < chain_.link_count; ++link) {
            if (thickest_m_[link] < 0.0) {
                continue;
            }
            const double m = thickest_m_[link] + k_disc_touch_m + ways.bulge_m[link] + k_rounding_m;
            const DiscBox& box = ways.box[link];
            const Limits limits = {{four_times(box.low.x() - m), four_times(box.low.y() - m)},
                                   {four_times(box.high.x() + m), four_times(box.high.y() + m)}};
            for (std::size_t four = 0; four < scratch_.bounds.size(); ++four) {
                const FourInts is_near = limits.may_meet(scratch_.bounds[four]);
                if (any_of(is_near)) {
                    add_near_of(ways, link, four, is_near, at, is_later);
                }
            }
        }
    }

    // What is beyond them on a side is not near.
    struct Limits {
        std::array<FourFloats, 2> low;
        std::array<FourFloats, 2> high;

        FourInts may_meet(const DiscScratch::FourBounds& bounds) const {
            return ~((bounds.low[0] > high[0]) | (bounds.low[1] > high[1]) |
                     (bounds.high[0] < low[0]) | (bounds.high[1] < low[1]));
        }
    };

    void add_near_of(const Ways& ways, std::size_t link, std::size_t four, const FourInts& is_near,
                     double at, bool is_later) {
        const std::uint32_t bit = 1U << link;
        const std::size_t end = std::min(4 * four + 4, segments_.size());
        for (std::size_t s = 4 * four; s < end; ++s) {
            const auto i = static_cast<std::uint32_t>(s);
            if (is_near[i % 4] == 0 || (scratch_.paired[i] & bit) != 0 ||
                chain_.radius_m[segments_[i].plane][link] < 0.0 || !may_touch(ways, link, i)) {
                continue;
            }
            scratch_.paired[i] |= bit;
            pairs_.push_back({at, 0.0, static_cast<std::uint32_t>(link), i, false, is_later});
        }
    }

    // Brings the pairs that may touch until `end` to the front; returns how many they are. The
    // others have their turn after it.
    std::size_t find_near(const Ways& ways, double end) {
        std::size_t near = 0;
        for (Pair& pair : pairs_) {
            const bool is_near = pair.leaving || may_touch(ways, pair.link, pair.segment);
            if (is_near && pair.next <= end) {
                std::swap(pairs_[near++], pair);
            } else if (!is_near) {
                pair.next = std::max(pair.next, end);
                pair.seen = true;
            }
        }
        return near;
    }

    // And those that were added, from `first` on, to them.
    std::size_t bring_to_front(std::size_t near, std::size_t first) {
        for (std::size_t i = first; i < pairs_.size(); ++i) {
            std::swap(pairs_[near++], pairs_[i]);
        }
        return near;
    }

    // Always the pair whose turn is next, and with it those whose turn is nearly there: where the
    // links are is found once for all of them. Of several that touch at once, the first link's.
    std::optional<Touch> first_touch_of(std::size_t near, double from, double end) {
        constexpr double k_together = 0.01;
        const std::span<Pair> pairs = std::span(pairs_).first(near);
        for (int round = 0; round < k_most_rounds && !pairs.empty(); ++round) {
            double at = pairs.front().next;
            for (const Pair& pair : pairs) {
                at = std::min(at, pair.next);
            }
            if (at > end) {
                break;
            }
            const ChainMotion motion = links_.motion_at(at);
            std::optional<Touch> first;
            for (Pair& pair : pairs) {
                const bool is_early = pair.next > at;
                if (pair.next <= at + k_together && !(is_early && pair.leaving) &&
                    touches(pair, motion, at)) {
                    // What comes apart no longer was less deep a step ago; nothing touched between.
                    const Touch touch = {pair.leaving ? std::max(at - k_leave_step, from) : at,
                                         pair.link, pair.segment};
                    first = first && !(touch < *first) ? *first : touch;
                }
            }
            if (first) {
                return first;
            }
        }
        return std::nullopt;
    }

    // What is near is told by Box2D, what is not by the closed form.
    double separation_m(const Pair& pair, const Gap& gap, const ChainMotion& motion) {
        const double free_m = gap.distance_m - radius_m(pair);
        if (free_m > k_surely_apart_m) {
            return free_m;
        }
        ++closure_.distances;
        const DiscSegment& segment = segments_[pair.segment];
        return disc_distance(motion.point[pair.link], motion.point[pair.link + 1], segment.a_ds,
                             segment.b_ds) -
               radius_m(pair);
    }

    bool gets_deeper(const Pair& pair, double at) {
        const ChainMotion later = links_.motion_at(at + k_leave_step);
        return separation_m(pair, gap_of(pair, later), later) < pair.separation_m;
    }

    // True where the pair touches at `at`; else moves pair.next on to where it may.
    bool touches(Pair& pair, const ChainMotion& motion, double at) {
        const double before_m = pair.separation_m;
        const bool was_seen = pair.seen;
        const Gap gap = gap_of(pair, motion);
        pair.separation_m = separation_m(pair, gap, motion);
        pair.seen = true;
        if (pair.leaving) {
            if (pair.separation_m < before_m - k_leave_noise_m) {
                return true;
            }
            pair.leaving = pair.separation_m < k_disc_clear_m;
        } else if (pair.separation_m <= k_disc_touch_m) {
            if (was_seen || gets_deeper(pair, at)) {
                return true;
            }
            pair.leaving = true;
        }
        pair.next =
            pair.leaving ? at + k_leave_step : next_touch(pair, gap, pair.separation_m, motion, at);
        return false;
    }

    const DiscChain& chain_;
    std::span<const DiscSegment> segments_;
    const DiscSweep& sweep_;
    DiscScratch& scratch_;
    std::vector<Pair>& pairs_;
    ClosingChain links_;
    std::array<double, k_most_disc_links> thickest_m_ = {-1.0, -1.0, -1.0};
    DiscClosure closure_;
};

}  // namespace

DiscClosure close_chain(const DiscChain& chain, std::span<const DiscSegment> segments,
                        const DiscSweep& sweep, DiscScratch& scratch) {
    HH_CHECK(chain.link_count >= 1 && chain.link_count <= k_most_disc_links,
             "a chain has one to three links", chain.link_count);
    return Closing(chain, segments, sweep, scratch).run();
}

}  // namespace handhold
