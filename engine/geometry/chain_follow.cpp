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
        for (int query = 1;; ++query) {
            if (is_crossed()) {
                return std::nullopt;
            }
            const std::size_t deepest = deepest_link();
            const bool is_penetrating = gap_m(deepest) < -settings_.touch_depth_m;
            frozen_links_ = is_penetrating ? 0 : touching_end();
            if (!is_penetrating && frozen_links_ > 0 && is_closed_beyond()) {
                return FollowedChain{angle_rad_, std::max(0.0, -gap_m(deepest)),
                                     static_cast<std::int32_t>(frozen_links_) - 1};
            }
            points_ds_ = chain_points_ds(chain_, angle_rad_);
            if (query == settings_.max_queries || !(is_penetrating ? open(deepest) : close())) {
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

    // Gap to the nearest surface; < 0: penetrating. query_gap_m if no surface is nearer.
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
        for (std::size_t i = frozen_links_; i < chain_.link_count; ++i) {
            is_closed = is_closed && angle_rad_[i] >= chain_.closed_rad[i] - k_at_limit_rad;
        }
        return is_closed;
    }

    // Turns hinges `first` to `last` by a fraction of their range from open to closed.
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

    // Rate of change of a link's gap g with the closing fraction s, while hinges first..link turn
    // together: dg/ds = sum_j range_j * n . perp(p - h_j). p is the point on the link's axis that
    // is nearest to the surface, n the unit direction from the surface to p, h_j is hinge j, and
    // perp turns by +90 degrees. Hinges at their limit towards `side` (1: closing, -1: opening) do
    // not move and are left out.
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

    // Depenetrates the link by opening its hinge and all hinges before it.
    bool open(std::size_t link) {
        const double opening = -opening_m(link, 0, -1.0);
        if (opening < k_min_opening_m) {
            return false;
        }
        const double share = (settings_.target_gap_m - gap_m(link)) / opening;
        total_opening_ += share;
        if (total_opening_ > settings_.max_opening) {
            return false;
        }
        turn(0, link, -share);
        return true;
    }

    // Closes the links beyond the last touching link until one of them touches.
    bool close() {
        // Closing fraction at the first new contact.
        double share = std::numeric_limits<double>::infinity();
        // Up to this fraction no surface farther away than query_gap_m can be reached.
        double unseen_share = share;
        for (std::size_t i = frozen_links_; i < chain_.link_count; ++i) {
            // Upper bound on the speed of the link's far end, per closing fraction.
            double arm_m = 0.0;
            for (std::size_t j = frozen_links_; j <= i; ++j) {
                const Vec2 arm = points_ds_[i + 1] - points_ds_[j];
                arm_m += range_rad(j) * arm.norm();
            }
            const double gap = gap_m(i);
            const double closing =
                gap < settings_.query_gap_m ? -opening_m(i, frozen_links_, 1.0) : 0.0;
            if (closing > k_min_opening_m) {
                share = std::min(share, (gap - settings_.target_gap_m) / closing);
            } else {
                unseen_share = std::min(unseen_share, gap / arm_m);
            }
        }
        total_closing_ += share;
        if (share > unseen_share || total_closing_ > settings_.max_closing) {
            return false;
        }
        turn(frozen_links_, chain_.link_count - 1, share);
        return true;
    }

    // Metres per full range; smaller rates are ignored.
    static constexpr double k_min_opening_m = 0.01;

    const HingeChain& chain_;
    ChainPatch& patch_;
    const ChainFollowSettings& settings_;
    ChainAngles angle_rad_ = {};
    ChainDepth depth_;
    std::array<Vec2, k_max_disc_links + 1> points_ds_;
    // The first `frozen_links_` links touch and keep their hinge angles.
    std::size_t frozen_links_ = 0;
    double total_opening_ = 0.0;
    double total_closing_ = 0.0;
};

}  // namespace

std::optional<FollowedChain> follow_chain(const HingeChain& chain, const ChainAngles& from_rad,
                                          const ChainDepth& depth, ChainPatch& patch,
                                          const ChainFollowSettings& settings) {
    return ChainFollower(chain, patch, settings).run(from_rad, depth);
}

}  // namespace handhold
