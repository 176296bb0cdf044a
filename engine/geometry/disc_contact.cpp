#include "engine/geometry/disc_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "engine/core/check.hpp"
#include "engine/geometry/closing_chain.hpp"
#include "engine/geometry/disc_gap.hpp"

namespace handhold {
namespace {

constexpr double k_disc_touch_m = 2e-5;  // largest separation at which a pair touches
// Separation that an advance aims for. It is below k_disc_touch_m, so that an approaching pair
// touches at the end of the advance.
constexpr double k_aim_m = 1e-5;
// A pair that moved out of an overlap may touch again once its separation has reached this value.
constexpr double k_disc_clear_m = 1e-4;
// Larger separations are computed in closed form. Smaller ones come from Box2D, whose error is at
// most 5e-7 m, and decide what touches.
constexpr double k_closed_form_above_m = 3e-5;
constexpr int k_max_rounds = 20000;  // guard; a few dozen are usual
constexpr double k_leave_step = 1.0 / 64.0;
constexpr double k_leave_noise_m = 1e-6;

// Axis-aligned box.
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

// Earliest time at which a point can have approached by d = `clearance_m`. v is its approach speed,
// a an upper bound on the rate at which v changes. Returns the positive root t of v t + a t^2 / 2 =
// d. The form for v > 0 avoids cancellation.
double time_to_cross(double clearance_m, double speed_m, double acceleration_m) {
    const double root = std::sqrt(speed_m * speed_m + 2.0 * acceleration_m * clearance_m);
    if (speed_m > 0.0) {
        return 2.0 * clearance_m / (speed_m + root);
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

class ChainCloser {
  public:
    ChainCloser(const DiscChain& chain, std::span<const DiscSegment> segments,
                const DiscSweep& sweep, DiscScratch& scratch)
        : chain_(chain),
          segments_(segments),
          sweep_(sweep),
          scratch_(scratch),
          pairs_(scratch.pairs),
          links_(chain, sweep.from) {
        prepare_segments();
    }

    DiscClosure run() {
        double at = sweep_.from;
        while (links_.first_free_hinge() < chain_.link_count) {
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

    // Computes the links' largest radii and the bounds of each group of four segments.
    void prepare_segments() {
        for (std::size_t link = 0; link < chain_.link_count; ++link) {
            for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
                max_radius_m_[link] = std::max(max_radius_m_[link], chain_.radius_m[plane][link]);
            }
        }
        scratch_.bounds.resize((segments_.size() + 3) / 4);
        for (std::size_t i = 0; i < 4 * scratch_.bounds.size(); ++i) {
            const DiscSegment& segment = segments_[std::min(i, segments_.size() - 1)];
            const DiscBox box(segment.a_ds, segment.b_ds);
            DiscScratch::Bounds4& bounds = scratch_.bounds[i / 4];
            bounds.low[0][i % 4] = static_cast<float>(box.low.x());
            bounds.low[1][i % 4] = static_cast<float>(box.low.y());
            bounds.high[0][i % 4] = static_cast<float>(box.high.x());
            bounds.high[1][i % 4] = static_cast<float>(box.high.y());
        }
    }

    double radius_m(const Pair& pair) const {
        return chain_.radius_m[segments_[pair.segment].plane][pair.link];
    }

    DiscGap gap_of(const Pair& pair, const ChainMotion& motion) const {
        return DiscGapFinder().run(motion.point[pair.link], motion.point[pair.link + 1],
                                   segments_[pair.segment]);
    }

    // Lower bound on the pair's contact time (conservative advancement). The line through
    // gap.on_segment, perpendicular to `gap.away`, separates the link from the segment. The pair
    // cannot touch before an end of the link has covered its distance from that line.
    double next_touch(const Pair& pair, const DiscGap& gap, double clearance_m,
                      const ChainMotion& motion, double at) const {
        double step = std::numeric_limits<double>::infinity();
        for (std::size_t end = pair.link; end <= pair.link + 1; ++end) {
            const double beyond_m =
                gap.away.dot(motion.point[end] - gap.on_segment) - gap.distance_m;
            step = std::min(step, time_to_cross(std::max(beyond_m, 0.0) + clearance_m - k_aim_m,
                                                -gap.away.dot(motion.velocity_m[end]),
                                                links_.acceleration_m(end)));
        }
        return at + step;
    }

    // The first contact at or after closing fraction `from`. Proceeds in intervals of the fraction;
    // in each, bounds of the swept links reject most pairs.
    std::optional<Touch> first_touch(double from) {
        constexpr double k_interval = 1.0 / 8.0;
        pairs_.clear();
        scratch_.paired.assign(segments_.size(), 0);
        ChainMotion before = links_.motion_at(from);
        double at = from;
        for (;;) {
            const double end = std::min(at + k_interval, sweep_.to);
            const ChainMotion after = links_.motion_at(end);
            const LinkSweeps sweeps = sweep_links(before, after, end - at);
            const std::size_t near = partition_near(sweeps, end);
            const std::size_t known = pairs_.size();
            add_near(sweeps, at, at > from);
            const std::optional<Touch> touch =
                first_touch_of(bring_to_front(near, known), from, end);
            if (touch || end >= sweep_.to) {
                return touch;
            }
            at = end;
            before = after;
        }
    }

    // Regions swept by the links in one interval.
    struct LinkSweeps {
        std::array<DiscBox, k_max_disc_links> box;
        // Sagitta: distance by which the links' arcs leave the box.
        std::array<double, k_max_disc_links> bulge_m = {};
    };
    LinkSweeps sweep_links(const ChainMotion& before, const ChainMotion& after,
                           double length) const {
        LinkSweeps sweeps;
        for (std::size_t link = links_.first_free_hinge(); link < chain_.link_count; ++link) {
            sweeps.box[link] = {before.point[link], before.point[link + 1]};
            sweeps.box[link].add({after.point[link], after.point[link + 1]});
            sweeps.bulge_m[link] = links_.acceleration_m(link + 1) * length * length / 8.0;
        }
        return sweeps;
    }

    bool may_touch(const LinkSweeps& sweeps, std::size_t link, std::uint32_t i) const {
        const DiscSegment& segment = segments_[i];
        const double reach_m =
            chain_.radius_m[segment.plane][link] + k_disc_touch_m + sweeps.bulge_m[link];
        return sweeps.box[link].is_within(reach_m, {segment.a_ds, segment.b_ds});
    }

    // Adds the pairs that come near for the first time in this interval. Most pairs do not; they
    // cost one test per four segments.
    void add_near(const LinkSweeps& sweeps, double at, bool is_later) {
        constexpr double k_float_rounding_m = 1e-5;  // holds for coordinates below 50 m
        for (std::size_t link = links_.first_free_hinge(); link < chain_.link_count; ++link) {
            if (max_radius_m_[link] < 0.0) {
                continue;
            }
            const double m =
                max_radius_m_[link] + k_disc_touch_m + sweeps.bulge_m[link] + k_float_rounding_m;
            const DiscBox& box = sweeps.box[link];
            const Limits limits = {{splat4(box.low.x() - m), splat4(box.low.y() - m)},
                                   {splat4(box.high.x() + m), splat4(box.high.y() + m)}};
            for (std::size_t four = 0; four < scratch_.bounds.size(); ++four) {
                const Int4 is_near = limits.may_meet(scratch_.bounds[four]);
                if (any_of(is_near)) {
                    add_near_of(sweeps, link, four, is_near, at, is_later);
                }
            }
        }
    }

    // Bounds of a swept link, each number in all lanes. may_meet is false for segments outside.
    struct Limits {
        std::array<Float4, 2> low;
        std::array<Float4, 2> high;

        Int4 may_meet(const DiscScratch::Bounds4& bounds) const {
            return ~((bounds.low[0] > high[0]) | (bounds.low[1] > high[1]) |
                     (bounds.high[0] < low[0]) | (bounds.high[1] < low[1]));
        }
    };

    void add_near_of(const LinkSweeps& sweeps, std::size_t link, std::size_t four,
                     const Int4& is_near, double at, bool is_later) {
        const std::uint32_t bit = 1U << link;
        const std::size_t end = std::min(4 * four + 4, segments_.size());
        for (std::size_t s = 4 * four; s < end; ++s) {
            const auto i = static_cast<std::uint32_t>(s);
            if (is_near[i % 4] == 0 || (scratch_.paired[i] & bit) != 0 ||
                chain_.radius_m[segments_[i].plane][link] < 0.0 || !may_touch(sweeps, link, i)) {
                continue;
            }
            scratch_.paired[i] |= bit;
            pairs_.push_back({at, 0.0, static_cast<std::uint32_t>(link), i, false, is_later});
        }
    }

    // Moves the pairs that may touch before `end` to the front and returns their number. The other
    // pairs are postponed to `end`.
    std::size_t partition_near(const LinkSweeps& sweeps, double end) {
        std::size_t near = 0;
        for (Pair& pair : pairs_) {
            const bool is_near = pair.leaving || may_touch(sweeps, pair.link, pair.segment);
            if (is_near && pair.next <= end) {
                std::swap(pairs_[near++], pair);
            } else if (!is_near) {
                pair.next = std::max(pair.next, end);
                pair.seen = true;
            }
        }
        return near;
    }

    // Also moves the pairs from index `first` on to the front. Returns the new number of pairs
    // there.
    std::size_t bring_to_front(std::size_t near, std::size_t first) {
        for (std::size_t i = first; i < pairs_.size(); ++i) {
            std::swap(pairs_[near++], pairs_[i]);
        }
        return near;
    }

    // Advances to the earliest time at which a pair may touch. Also evaluates the pairs that are
    // due shortly after, because they can share the links' motion. Of simultaneous contacts,
    // returns that of the first link.
    std::optional<Touch> first_touch_of(std::size_t near, double from, double end) {
        constexpr double k_simultaneous = 0.01;
        const std::span<Pair> pairs = std::span(pairs_).first(near);
        for (int round = 0; round < k_max_rounds && !pairs.empty(); ++round) {
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
                if (pair.next <= at + k_simultaneous && !(is_early && pair.leaving) &&
                    touches(pair, motion, at)) {
                    // A pair that was moving apart gets deeper again: it touches at the last step,
                    // when it was shallower.
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

    // Uses GJK near contact and the closed form for larger separations.
    double separation_m(const Pair& pair, const DiscGap& gap, const ChainMotion& motion) {
        const double clearance_m = gap.distance_m - radius_m(pair);
        if (clearance_m > k_closed_form_above_m) {
            return clearance_m;
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

    // True if the pair touches at `at`. Otherwise moves pair.next to the next time it may touch.
    bool touches(Pair& pair, const ChainMotion& motion, double at) {
        const double before_m = pair.separation_m;
        const bool was_seen = pair.seen;
        const DiscGap gap = gap_of(pair, motion);
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
    std::array<double, k_max_disc_links> max_radius_m_ = {-1.0, -1.0, -1.0};
    DiscClosure closure_;
};

}  // namespace

DiscClosure close_chain(const DiscChain& chain, std::span<const DiscSegment> segments,
                        const DiscSweep& sweep, DiscScratch& scratch) {
    HH_CHECK(chain.link_count >= 1 && chain.link_count <= k_max_disc_links,
             "a chain has one to three links", chain.link_count);
    return ChainCloser(chain, segments, sweep, scratch).run();
}

}  // namespace handhold
