#include "systems/hand/shared/thumb_closing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "systems/hand/shared/finger_chain.hpp"

namespace handhold {
namespace {

constexpr double k_max_tip_gap_m = 0.05;

// Gap between the tip's end and the nearest surface, at most k_max_tip_gap_m.
double tip_gap_m(const Capsule& tip, std::span<const PlacedMesh> meshes) {
    double gap_m = k_max_tip_gap_m;
    for (const PlacedMesh& placed : meshes) {
        const Vec3 point = inverse_transform_point(placed.pose, tip.ends[1]);
        const auto near = placed.mesh->contact_bvh.closest_point(point, gap_m + tip.radius_m);
        if (near) {
            gap_m = std::min(gap_m, std::max(0.0, near->distance_m - tip.radius_m));
        }
    }
    return gap_m;
}

class ThumbCloser {
  public:
    ThumbCloser(const ClosingThumb& closing, const ThumbTuning& tuning, ChainFitScratch& scratch)
        : closing_(closing), tuning_(tuning), scratch_(scratch) {}

    ChainFit close(double opposition_rad, const ChainFitSettings& settings) const {
        const HingeChain chain = chain_at(opposition_rad);
        return fit_chain(chain, closing_.hand.meshes,
                         chain_seed(closing_.hand, closing_.surface, chain), settings, scratch_);
    }

    double cost_m(const ClosedThumb& closed) const {
        const auto capsules = chain_capsules(chain_at(closed.opposition_rad), closed.fit.angle_rad);
        const Capsule& tip = capsules[closing_.thumb.link_count - 1];
        return tuning_.penetration_cost * (closed.fit.depth_m + overlap_m(closed)) +
               (closed.touches ? 0.0 : tuning_.open_cost_m) +
               tuning_.tip_gap_cost * tip_gap_m(tip, closing_.hand.meshes) +
               tuning_.opposition_cost_m_per_rad *
                   std::abs(closed.opposition_rad - rest_opposition_rad(closing_.thumb, tuning_));
    }

    double overlap_m(const ClosedThumb& closed) const {
        const auto capsules = chain_capsules(chain_at(closed.opposition_rad), closed.fit.angle_rad);
        return thumb_overlap_m(*closing_.hand.rig, closing_.fingers,
                               std::span(capsules).first(closing_.thumb.link_count));
    }

    // Opens a thumb that crosses fingers, all hinges by the same share, until it is clear of them,
    // and returns true. Returns false if it does not cross any, or is never clear.
    bool stop_at_fingers(ClosedThumb& closed) const {
        constexpr int k_steps = 8;
        constexpr double k_clear_of_fingers_m = 1e-3;
        const ChainAngles whole_rad = closed.fit.angle_rad;
        if (overlap_m(closed) <= k_clear_of_fingers_m) {
            return false;
        }
        closed.touches = false;
        for (int step = k_steps; step-- > 0;) {
            for (std::size_t i = 0; i < closing_.thumb.link_count; ++i) {
                const double open_rad = closing_.thumb.lower_rad[i];
                closed.fit.angle_rad[i] = open_rad + (whole_rad[i] - open_rad) * step / k_steps;
            }
            if (overlap_m(closed) <= k_clear_of_fingers_m) {
                closed.fit.depth_m =
                    posed_depth_m(chain_at(closed.opposition_rad), closed.fit.angle_rad,
                                  closing_.hand.meshes, scratch_.patch);
                return true;
            }
        }
        return false;
    }

  private:
    HingeChain chain_at(double opposition_rad) const {
        return finger_chain(closing_.thumb, opposition_rad, closing_.wrist_bs);
    }

    const ClosingThumb& closing_;
    const ThumbTuning& tuning_;
    ChainFitScratch& scratch_;
};

void add_visits(const ChainFit& other, ChainFit& fit) {
    fit.discs += other.discs;
    fit.pops += other.pops;
    fit.walked += other.walked;
}

}  // namespace

double rest_opposition_rad(const FingerRig& thumb, const ThumbTuning& tuning) {
    return std::clamp(tuning.rest_opposition_rad, thumb.lower_opposition_rad,
                      std::max(thumb.lower_opposition_rad, thumb.upper_opposition_rad));
}

ClosedThumb close_thumb(const ClosingThumb& closing, const ChainFitSettings& settings,
                        const ThumbTuning& tuning, ChainFitScratch& scratch) {
    const ThumbCloser closer(closing, tuning, scratch);
    const FingerRig& thumb = closing.thumb;
    const double rest_rad = rest_opposition_rad(thumb, tuning);
    // Candidates are closed without depenetration, which is expensive; only the chosen opposition
    // gets it.
    ChainFitSettings quick = settings;
    quick.depenetrates = false;
    const int steps = std::max(1, tuning.opposition_steps);
    ClosedThumb best;
    ChainFit visits;
    double best_m = std::numeric_limits<double>::infinity();
    const auto consider = [&](const ClosedThumb& closed) {
        const double cost_m = closer.cost_m(closed);
        const bool is_nearer = cost_m == best_m && std::abs(closed.opposition_rad - rest_rad) <
                                                       std::abs(best.opposition_rad - rest_rad);
        if (cost_m < best_m || is_nearer) {
            best_m = cost_m;
            best = closed;
        }
    };
    for (int step = 0; step < steps; ++step) {
        const double share = steps > 1 ? static_cast<double>(step) / (steps - 1) : 0.5;
        const double opposition_rad =
            thumb.lower_opposition_rad +
            share * (thumb.upper_opposition_rad - thumb.lower_opposition_rad);
        ClosedThumb closed{opposition_rad, closer.close(opposition_rad, quick)};
        closed.touches = touches(closed.fit);
        add_visits(closed.fit, visits);
        consider(closed);
        if (closer.stop_at_fingers(closed)) {
            consider(closed);
        }
    }
    if (best.fit.needs_depenetration && best.touches) {
        best.fit = closer.close(best.opposition_rad, settings);
        best.touches = touches(best.fit);
        add_visits(best.fit, visits);
    }
    best.fit.discs = visits.discs;
    best.fit.pops = visits.pops;
    best.fit.walked = visits.walked;
    return best;
}

}  // namespace handhold
