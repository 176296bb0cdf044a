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

    double cost_m(double opposition_rad, const ChainFit& fit) const {
        const auto capsules = chain_capsules(chain_at(opposition_rad), fit.angle_rad);
        const Capsule& tip = capsules[closing_.thumb.link_count - 1];
        return tuning_.penetration_cost * fit.depth_m + (touches(fit) ? 0.0 : tuning_.open_cost_m) +
               tuning_.tip_gap_cost * tip_gap_m(tip, closing_.hand.meshes) +
               tuning_.opposition_cost_m_per_rad *
                   std::abs(opposition_rad - rest_opposition_rad(closing_.thumb, tuning_));
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
    // Only the chosen opposition is worth a depenetration.
    ChainFitSettings quick = settings;
    quick.depenetrates = false;
    const int steps = std::max(1, tuning.opposition_steps);
    ClosedThumb best;
    ChainFit visits;
    double best_m = std::numeric_limits<double>::infinity();
    for (int step = 0; step < steps; ++step) {
        const double share = steps > 1 ? static_cast<double>(step) / (steps - 1) : 0.5;
        const double opposition_rad =
            thumb.lower_opposition_rad +
            share * (thumb.upper_opposition_rad - thumb.lower_opposition_rad);
        const ChainFit fit = closer.close(opposition_rad, quick);
        const double cost_m = closer.cost_m(opposition_rad, fit);
        const bool is_nearer = cost_m == best_m && std::abs(opposition_rad - rest_rad) <
                                                       std::abs(best.opposition_rad - rest_rad);
        add_visits(fit, visits);
        if (cost_m < best_m || is_nearer) {
            best_m = cost_m;
            best = {opposition_rad, fit};
        }
    }
    if (best.fit.needs_depenetration) {
        best.fit = closer.close(best.opposition_rad, settings);
        add_visits(best.fit, visits);
    }
    best.fit.discs = visits.discs;
    best.fit.pops = visits.pops;
    best.fit.walked = visits.walked;
    return best;
}

}  // namespace handhold
