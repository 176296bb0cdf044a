#include "engine/geometry/disc_contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr double k_touch_m = 2e-5;         // nearer counts as touching
constexpr double k_least_move_m = 4e-5;    // a step moves no point of a link farther than its
                                           // distance, or than this: what an advance may sink
constexpr double k_clear_m = 1e-4;         // what left an overlap by this much can touch again
constexpr double k_surely_apart_m = 2e-3;  // up to here a bound does instead of the distance
constexpr int k_most_rounds = 20000;       // more than steps of k_least_move_m can be
constexpr double k_leave_step = 1.0 / 64.0;
constexpr double k_leave_noise_m = 1e-6;

struct Link {
    Vec2 begin;
    Vec2 end;
};

// Where the links are while those before `first_free` keep their angles.
class ClosingChain {
  public:
    ClosingChain(const DiscChain& chain, double at) : chain_(chain) {
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
    }

    double angle_at(std::size_t hinge, double at) const {
        return chain_.open_rad[hinge] + at * (chain_.closed_rad[hinge] - chain_.open_rad[hinge]);
    }

    std::array<Link, k_most_disc_links> links_at(double at) const {
        std::array<Link, k_most_disc_links> links;
        Vec2 begin = Vec2::Zero();
        double angle = 0.0;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            angle += i < first_free_ ? angle_rad_[i] : angle_at(i, at);
            double sine = 0.0;
            double cosine = 1.0;
            sin_cos(angle, sine, cosine);
            const Vec2 end = begin + chain_.length_m[i] * Vec2(cosine, sine);
            links[i] = {begin, end};
            begin = end;
        }
        return links;
    }

    // No point of the link's middle moves faster, metres for the whole closing.
    double speed_m(std::size_t link) const {
        double reach_m = 0.0;
        double speed_m = 0.0;
        for (std::size_t i = link + 1; i-- > first_free_;) {
            reach_m += chain_.length_m[i];
            speed_m += std::abs(chain_.closed_rad[i] - chain_.open_rad[i]) * reach_m;
        }
        return std::max(speed_m, 1e-6);
    }

    // Hinges up to and with `last` keep the angles they have at `at`.
    void freeze(std::size_t last, double at) {
        for (std::size_t i = first_free_; i <= last; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
        first_free_ = last + 1;
    }

    std::size_t first_free() const { return first_free_; }
    const std::array<double, k_most_disc_links>& angle_rad() const { return angle_rad_; }

  private:
    const DiscChain& chain_;
    std::array<double, k_most_disc_links> angle_rad_ = {};
    std::size_t first_free_ = 0;
};

struct Touch {
    double at = 0.0;
    std::size_t link = 0;
    std::uint32_t segment = 0;
};

class Closing {
  public:
    Closing(const DiscChain& chain, std::span<const DiscSegment> segments, const DiscSweep& sweep,
            DiscScratch& scratch)
        : chain_(chain),
          segments_(segments),
          sweep_(sweep),
          pairs_(scratch.pairs),
          links_(chain, sweep.from) {}

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
    using Links = std::array<Link, k_most_disc_links>;

    static double distance_to(const Vec2& point, const Vec2& a, const Vec2& b) {
        const Vec2 along = b - a;
        const double length2 = along.squaredNorm();
        const double t =
            length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
        return (a + t * along - point).norm();
    }

    // No more than the distance: what each is from a circle about the other.
    static double least_distance(const Link& link, const DiscSegment& segment) {
        const Vec2 half_segment = 0.5 * (segment.b_ds - segment.a_ds);
        const Vec2 half_link = 0.5 * (link.end - link.begin);
        return std::max(
            distance_to(segment.a_ds + half_segment, link.begin, link.end) - half_segment.norm(),
            distance_to(link.begin + half_link, segment.a_ds, segment.b_ds) - half_link.norm());
    }

    void gather_pairs(double at) {
        pairs_.clear();
        const Links places = links_.links_at(at);
        for (std::size_t link = links_.first_free(); link < chain_.link_count; ++link) {
            speed_m_[link] = links_.speed_m(link);
            for (std::uint32_t i = 0; i < segments_.size(); ++i) {
                const double radius_m = chain_.radius_m[segments_[i].plane][link];
                if (radius_m < 0.0) {
                    continue;
                }
                const double free_m =
                    least_distance(places[link], segments_[i]) - radius_m - k_touch_m;
                const double next = at + std::max(free_m, 0.0) / speed_m_[link];
                if (next <= sweep_.to) {
                    pairs_.push_back(
                        {next, 0.0, static_cast<std::uint32_t>(link), i, false, free_m > 0.0});
                }
            }
        }
    }

    // Always the pair whose turn is next, and with it those whose turn is nearly there: where the
    // links are is found once for all of them. Ties go to the first link and segment.
    std::optional<Touch> first_touch(double from) {
        constexpr double k_together = 0.01;
        gather_pairs(from);
        for (int round = 0; round < k_most_rounds && !pairs_.empty(); ++round) {
            double at = pairs_.front().next;
            for (const Pair& pair : pairs_) {
                at = std::min(at, pair.next);
            }
            if (!(at <= sweep_.to)) {
                break;
            }
            const Links places = links_.links_at(at);
            for (Pair& pair : pairs_) {
                const bool is_early = pair.next > at;
                if (pair.next <= at + k_together && !(is_early && pair.leaving) &&
                    touches(pair, places, at)) {
                    // What comes apart no longer was less deep a step ago; nothing touched between.
                    const double stop_at = pair.leaving ? std::max(at - k_leave_step, from) : at;
                    return Touch{stop_at, pair.link, pair.segment};
                }
            }
        }
        return std::nullopt;
    }

    double separation_m(const Pair& pair, const Links& places) {
        const Link& link = places[pair.link];
        const DiscSegment& segment = segments_[pair.segment];
        const double radius_m = chain_.radius_m[segment.plane][pair.link];
        const double least_m = least_distance(link, segment) - radius_m;
        if (least_m > k_surely_apart_m) {
            return least_m;
        }
        ++closure_.distances;
        return disc_distance(link.begin, link.end, segment.a_ds, segment.b_ds) - radius_m;
    }

    // True where the pair touches at `at`; else moves pair.next on to where it may.
    bool touches(Pair& pair, const Links& places, double at) {
        const double before_m = pair.separation_m;
        const bool was_seen = pair.seen;
        pair.separation_m = separation_m(pair, places);
        pair.seen = true;
        if (pair.leaving) {
            if (pair.separation_m < before_m - k_leave_noise_m) {
                return true;
            }
            pair.leaving = pair.separation_m < k_clear_m;
        } else if (pair.separation_m <= k_touch_m) {
            if (was_seen ||
                separation_m(pair, links_.links_at(at + k_leave_step)) < pair.separation_m) {
                return true;
            }
            pair.leaving = true;
        }
        pair.next = at + (pair.leaving ? k_leave_step
                                       : std::max(pair.separation_m - k_touch_m, k_least_move_m) /
                                             speed_m_[pair.link]);
        return false;
    }

    const DiscChain& chain_;
    std::span<const DiscSegment> segments_;
    const DiscSweep& sweep_;
    std::vector<Pair>& pairs_;
    ClosingChain links_;
    std::array<double, k_most_disc_links> speed_m_ = {};
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
