#include "engine/geometry/chain_refit.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/chain_follow.hpp"

namespace handhold {
namespace {

class ChainRefitter {
  public:
    ChainRefitter(const HingeChain& chain, const ChainFitSettings& settings,
                  const ChainRefitSettings& refit, ChainFitScratch& scratch)
        : chain_(chain), settings_(settings), refit_(refit), scratch_(scratch) {}

    ChainFit run(const ChainAngles& last_rad, std::span<const PlacedMesh> meshes) {
        fit_.angle_rad = within_limits(last_rad);
        gather_near(meshes);
        const ChainDepth depth = depth_of(fit_.angle_rad, refit_.query_gap_m);
        if (follow(depth)) {
            return fit_;
        }
        const double penetration_m = depth.depth_m - refit_.query_gap_m;
        if (penetration_m > refit_.touch_depth_m) {
            if (!open(own_depth(chain_, depth, chain_.link_count))) {
                return fit_;
            }
        } else if (penetration_m > -refit_.touch_gap_m) {
            stay(depth);
            if (is_done()) {
                return fit_;
            }
        }
        close_on(meshes);
        return fit_;
    }

  private:
    // The angles after turning the hinges up to and including `last` by a fraction of their range.
    ChainAngles moved_by(const ChainAngles& angle_rad, double share,
                         std::size_t last = k_max_disc_links) const {
        ChainAngles moved_rad = angle_rad;
        for (std::size_t i = 0; i < chain_.link_count && i <= last; ++i) {
            moved_rad[i] += share * (chain_.closed_rad[i] - chain_.open_rad[i]);
        }
        return within_limits(moved_rad);
    }

    ChainAngles within_limits(const ChainAngles& angle_rad) const {
        ChainAngles limited_rad = {};
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            limited_rad[i] =
                std::max(std::min(angle_rad[i], chain_.closed_rad[i]), chain_.open_rad[i]);
        }
        return limited_rad;
    }

    // Gathers the triangles that the chain can reach in one opening or closing.
    void gather_near(std::span<const PlacedMesh> meshes) {
        gather_between(moved_by(fit_.angle_rad, -refit_.open_share * refit_.open_steps),
                       moved_by(fit_.angle_rad, refit_.close_share), meshes);
    }

    // Gathers the triangles that the chain can reach on its way to fully closed or to rest.
    void gather_all(std::span<const PlacedMesh> meshes) {
        gather_between(lowest(fit_.angle_rad, chain_.rest_rad),
                       highest(chain_.closed_rad, chain_.rest_rad), meshes);
    }

    // Gathers the triangles that the chain can reach with each hinge anywhere between two angles.
    void gather_between(const ChainAngles& min_rad, const ChainAngles& max_rad,
                        std::span<const PlacedMesh> meshes) {
        ChainReach reach = chain_reach(chain_, min_rad, max_rad, refit_.query_gap_m);
        reach.half_width_m = half_width_m(chain_, settings_.plane_offset);
        scratch_.patch.gather(reach, meshes);
    }

    ChainDepth depth_of(const ChainAngles& angle_rad, double extra_radius_m) const {
        return chain_depth(chain_, angle_rad, scratch_.patch, {.extra_radius_m = extra_radius_m});
    }

    // Follows a nearby surface. False if it does not converge: the chain must be closed again.
    bool follow(const ChainDepth& depth) {
        const ChainFollowSettings settings = {
            .touch_gap_m = refit_.touch_gap_m,
            .touch_depth_m = refit_.touch_depth_m,
            .query_gap_m = refit_.query_gap_m,
            .max_opening = refit_.open_share * refit_.open_steps,
            .max_closing = std::min(refit_.close_share, turn_share())};
        const auto followed = follow_chain(chain_, fit_.angle_rad, depth, scratch_.patch, settings);
        if (followed) {
            fit_.angle_rad = followed->angle_rad;
            fit_.depth_m = followed->depth_m;
            fit_.contact_link = followed->last_touching_link;
        }
        return followed.has_value();
    }

    // Opens the hinges up to the deepest link until the chain is clear. Returns false if it stays
    // penetrating, and then keeps the pose with the smallest depth.
    bool open(ChainDepth depth) {
        ChainAngles angle_rad = fit_.angle_rad;
        fit_.depth_m = depth.depth_m;
        fit_.contact_link = static_cast<std::int32_t>(depth.link);
        for (std::int32_t step = 0; step < refit_.open_steps && depth.depth_m > 0.0; ++step) {
            angle_rad = moved_by(angle_rad, -refit_.open_share, depth.link);
            depth = depth_of(angle_rad, 0.0);
            if (depth.depth_m < fit_.depth_m) {
                fit_.angle_rad = angle_rad;
                fit_.depth_m = depth.depth_m;
                fit_.fallback = ChainFallback::opened;
            }
        }
        return depth.depth_m <= 0.0;
    }

    // Largest fraction of the range by which no hinge turns more than max_turn_rad.
    double turn_share() const {
        double max_rad = 0.0;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            max_rad = std::max(max_rad, chain_.closed_rad[i] - chain_.open_rad[i]);
        }
        return refit_.max_turn_rad < max_rad ? refit_.max_turn_rad / max_rad : 1.0;
    }

    // Freezes the hinges up to and including the last link that touches.
    void stay(const ChainDepth& depth) {
        fit_.depth_m = std::max(0.0, depth.depth_m - refit_.query_gap_m);
        for (std::size_t i = 0; i < depth.end; ++i) {
            const bool touches = depth.nearest_m[i] < chain_.radius_m[i] + refit_.touch_gap_m;
            frozen_links_ = touches ? i + 1 : frozen_links_;
        }
        unmoved_links_ = frozen_links_;
        unmoved_depth_m_ = own_depth(chain_, depth, frozen_links_).depth_m;
        fit_.contact_link = static_cast<std::int32_t>(frozen_links_) - 1;
    }

    // True if the last link touches, or if all links beyond the contact are fully closed.
    bool is_done() const {
        constexpr double k_at_limit_rad = 1e-9;
        if (fit_.contact_link == DiscClosure::k_none) {
            return false;
        }
        bool is_closed = true;
        for (auto i = static_cast<std::size_t>(fit_.contact_link) + 1; i < chain_.link_count; ++i) {
            is_closed = is_closed && fit_.angle_rad[i] >= chain_.closed_rad[i] - k_at_limit_rad;
        }
        return is_closed;
    }

    // Closes the links that are not frozen until they touch.
    void close_on(std::span<const PlacedMesh> meshes) {
        const double turn = turn_share();
        fit_.contact_link = static_cast<std::int32_t>(frozen_links_) - 1;
        if (frozen_links_ == 0 && refit_.has_surface_ahead == false && return_to_rest()) {
            return;
        }
        cut();
        const DiscClosure closure = closure_by(std::min(refit_.close_share, turn));
        const bool touches = frozen_links_ > 0 || closure.contact_link != DiscClosure::k_none;
        const bool goes_on =
            !touches && refit_.has_surface_ahead == true && turn <= refit_.close_share;
        if (touches || goes_on) {
            take(closure);
            fit_.is_turn_limited = !is_done();
        }
        if ((!touches && !goes_on) || (fit_.is_turn_limited && turn > refit_.close_share)) {
            const std::int32_t kept = fit_.contact_link + 1;
            frozen_links_ = static_cast<std::size_t>(kept);
            close_far(meshes, touches && turn < 1.0 ? turn - refit_.close_share : turn);
        }
    }

    // Looks for a surface over the whole range. Turns towards it by `turn`, a fraction of the
    // range. Returns to rest if there is none.
    void close_far(std::span<const PlacedMesh> meshes, double turn) {
        gather_all(meshes);
        cut();
        const DiscClosure whole = closure_by(1.0);
        fit_.has_look_ahead = frozen_links_ == 0;
        fit_.has_surface_ahead = whole.contact_link != DiscClosure::k_none;
        if (frozen_links_ == 0 && !fit_.has_surface_ahead) {
            return_to_rest();
            return;
        }
        take(turn < 1.0 ? closure_by(turn) : whole);
        fit_.is_turn_limited = !is_done();
    }

    void cut() {
        scratch_.segments.clear();
        for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
            scratch_.patch.cut(plane_offset_m(chain_, settings_.plane_offset, plane),
                               static_cast<std::uint32_t>(plane), scratch_.segments);
        }
    }

    DiscClosure closure_by(double share) {
        DiscChain flat = flat_chain(chain_, settings_.plane_offset);
        flat.open_rad = fit_.angle_rad;
        flat.closed_rad = fit_.angle_rad;
        for (std::size_t i = frozen_links_; i < chain_.link_count; ++i) {
            // Turns as fast as a full closing would, but stops at the hinge's limit.
            flat.closed_rad[i] += std::min(chain_.closed_rad[i] - chain_.open_rad[i],
                                           (chain_.closed_rad[i] - fit_.angle_rad[i]) / share);
        }
        return close_chain(flat, scratch_.segments, {0.0, share}, scratch_.disc);
    }

    void take(const DiscClosure& closure) {
        const std::int32_t kept_link = static_cast<std::int32_t>(frozen_links_) - 1;
        fit_.contact_link = std::max(kept_link, closure.contact_link);
        fit_.angle_rad = within_limits(closure.angle_rad);
        const ChainDepth others =
            chain_depth(chain_, fit_.angle_rad, scratch_.patch, {.first = unmoved_links_});
        fit_.depth_m = std::max(unmoved_depth_m_, others.depth_m);
        fit_.fallback = ChainFallback::none;
    }

    // Turns towards the rest pose as far as max_turn_rad allows. If the pose reached penetrates,
    // stays and returns false.
    bool return_to_rest() {
        fit_.fallback = ChainFallback::rest_pose;
        fit_.contact_link = DiscClosure::k_none;
        double max_rad = 0.0;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            max_rad = std::max(max_rad, std::abs(chain_.rest_rad[i] - fit_.angle_rad[i]));
        }
        const double share = refit_.max_turn_rad < max_rad ? refit_.max_turn_rad / max_rad : 1.0;
        ChainAngles angle_rad = fit_.angle_rad;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            angle_rad[i] += share * (chain_.rest_rad[i] - angle_rad[i]);
        }
        const double depth_m = depth_of(angle_rad, 0.0).depth_m;
        if (depth_m <= settings_.open_depth_m) {
            fit_.angle_rad = angle_rad;
            fit_.depth_m = depth_m;
            fit_.is_turn_limited = share < 1.0;
            return true;
        }
        return false;
    }

    const HingeChain& chain_;
    const ChainFitSettings& settings_;
    const ChainRefitSettings& refit_;
    ChainFitScratch& scratch_;
    ChainFit fit_;
    // The first `unmoved_links_` links have not moved since the depth query.
    std::size_t unmoved_links_ = 0;
    double unmoved_depth_m_ = 0.0;  // largest depth of the unmoved links
    // The first `frozen_links_` links touch and keep their hinge angles.
    std::size_t frozen_links_ = 0;
};

}  // namespace

ChainFit refit_chain(const HingeChain& chain, const ChainAngles& last_rad,
                     std::span<const PlacedMesh> meshes, const ChainFitSettings& settings,
                     const ChainRefitSettings& refit, ChainFitScratch& scratch) {
    return ChainRefitter(chain, settings, refit, scratch).run(last_rad, meshes);
}

}  // namespace handhold
