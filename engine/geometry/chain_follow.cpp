#include "engine/geometry/chain_follow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handhold {
namespace {

class ChainFollower {
  public:
    ChainFollower(const HingeChain& chain, ChainPatch& patch, const ChainFollowSettings& settings)
        : chain_(chain), patch_(patch), settings_(settings) {}

    std::optional<FollowedChain> run(const ChainAngles& from_rad, const ChainDepth& depth) {
        angle_rad_ = from_rad;
        depth_ = depth;
        for (int look = 1;; ++look) {
            if (is_crossed()) {
                return std::nullopt;
            }
            const std::size_t deepest = deepest_link();
            const bool is_penetrating = gap_m(deepest) < -settings_.touch_depth_m;
            kept_ = is_penetrating ? 0 : touching_end();
            if (!is_penetrating && kept_ > 0 && is_closed_beyond()) {
                return FollowedChain{angle_rad_, std::max(0.0, -gap_m(deepest)),
                                     static_cast<std::int32_t>(kept_) - 1};
            }
            points_ds_ = chain_points_ds(chain_, angle_rad_);
            if (look == settings_.max_queries || !(is_penetrating ? open(deepest) : close())) {
                return std::nullopt;
            }
            depth_ =
                chain_depth(chain_, angle_rad_, patch_, {.extra_radius_m = settings_.query_gap_m});
        }
    }

  private:
    bool is_crossed() const {
        return depth_.end < chain_.link_count ||
               std::ranges::any_of(depth_.beyond_m, [](double beyond_m) { return beyond_m > 0.0; });
    }

    // Below 0 it is sunk; query_gap_m: no surface is as near.
    double gap_m(std::size_t link) const { return depth_.nearest_m[link] - chain_.radius_m[link]; }

    std::size_t deepest_link() const {
        std::size_t deepest = 0;
        for (std::size_t i = 1; i < chain_.link_count; ++i) {
            deepest = gap_m(i) < gap_m(deepest) ? i : deepest;
        }
        return deepest;
    }

    std::size_t touching_end() const {
        std::size_t end = 0;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            end = gap_m(i) < settings_.touch_gap_m ? i + 1 : end;
        }
        return end;
    }

    bool is_closed_beyond() const {
        constexpr double k_at_limit_rad = 1e-9;
        bool is_closed = true;
        for (std::size_t i = kept_; i < chain_.link_count; ++i) {
            is_closed = is_closed && angle_rad_[i] >= chain_.closed_rad[i] - k_at_limit_rad;
        }
        return is_closed;
    }

    // Turns hinges from `first` to `last` by a share of their way from open to closed.
    void turn(std::size_t first, std::size_t last, double share) {
        for (std::size_t i = first; i <= last; ++i) {
            angle_rad_[i] += share * range_rad(i);
            angle_rad_[i] =
                std::max(std::min(angle_rad_[i], chain_.closed_rad[i]), chain_.open_rad[i]);
        }
    }
    double range_rad(std::size_t hinge) const {
        return chain_.closed_rad[hinge] - chain_.open_rad[hinge];
    }

    // How fast the link's gap opens, by the share that hinges from `first` to its own close.
    double opening_m(std::size_t link, std::size_t first, double side) const {
        double sum_m = 0.0;
        for (std::size_t i = first; i <= link; ++i) {
            const double limit_rad = side > 0.0 ? chain_.closed_rad[i] : chain_.open_rad[i];
            if (angle_rad_[i] != limit_rad) {
                const Vec2 arm = depth_.nearest_ds[link] - points_ds_[i];
                sum_m += range_rad(i) * depth_.away_ds[link].dot(Vec2(-arm.y(), arm.x()));
            }
        }
        return sum_m;
    }

    // Out of what the link is sunk in, with all hinges up to its own.
    bool open(std::size_t link) {
        const double opening = -opening_m(link, 0, -1.0);
        if (opening < k_least_opening_m) {
            return false;
        }
        const double share = (settings_.target_gap_m - gap_m(link)) / opening;
        opened_ += share;
        if (opened_ > settings_.max_opening) {
            return false;
        }
        turn(0, link, -share);
        return true;
    }

    // What is beyond the links that touch, until the first of it does.
    bool close() {
        double share = std::numeric_limits<double>::infinity();  // until something is touched
        double unseen = share;  // as far as what no link sees cannot be touched
        for (std::size_t i = kept_; i < chain_.link_count; ++i) {
            double arm_m = 0.0;  // how fast its end goes, by the share
            for (std::size_t j = kept_; j <= i; ++j) {
                const Vec2 arm = points_ds_[i + 1] - points_ds_[j];
                arm_m += range_rad(j) * arm.norm();
            }
            const double gap = gap_m(i);
            const double closing = gap < settings_.query_gap_m ? -opening_m(i, kept_, 1.0) : 0.0;
            if (closing > k_least_opening_m) {
                share = std::min(share, (gap - settings_.target_gap_m) / closing);
            } else {
                unseen = std::min(unseen, gap / arm_m);
            }
        }
        closed_ += share;
        if (share > unseen || closed_ > settings_.max_closing) {
            return false;
        }
        turn(kept_, chain_.link_count - 1, share);
        return true;
    }

    static constexpr double k_least_opening_m = 0.01;  // by the whole way: less is no help

    const HingeChain& chain_;
    ChainPatch& patch_;
    const ChainFollowSettings& settings_;
    ChainAngles angle_rad_ = {};
    ChainDepth depth_;
    std::array<Vec2, k_max_disc_links + 1> points_ds_;
    std::size_t kept_ = 0;  // links up to there touch: their hinges stay
    double opened_ = 0.0;
    double closed_ = 0.0;
};

}  // namespace

std::optional<FollowedChain> follow_chain(const HingeChain& chain, const ChainAngles& from_rad,
                                          const ChainDepth& depth, ChainPatch& patch,
                                          const ChainFollowSettings& settings) {
    return ChainFollower(chain, patch, settings).run(from_rad, depth);
}

}  // namespace handhold
