#include "systems/hand/search_grip.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_candidates.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {
namespace {

// A search ends after this many consecutive pops without a cheaper triangle.
constexpr std::uint32_t k_max_idle_pops = 24;
// The same limit while following last frame's surface.
constexpr std::uint32_t k_follow_max_idle_pops = 6;
constexpr double k_full_search_interval_m = 0.006;  // travel between full searches
constexpr std::uint32_t k_max_stationary_refine_frames = 24;

// The surface nearest to a palm in an authored grip. It seeds the searches of the closing fingers.
GripSurface authored_grip_surface(const HandSurroundings& hand, double dt_s,
                                  const PalmTuning& tuning) {
    const PalmFitter fitter(hand, hand.authored->wrist_bs, dt_s, tuning);
    const auto near =
        fitter.placed().mesh->search_bvh.closest_point(fitter.palm().center, tuning.reach_m);
    GripSurface surface;
    if (near) {
        surface = fitter.surface_at({near->triangle, near->point, 0.0});
    }
    surface.wrist_bs = hand.authored->wrist_bs;
    // Invalid key: forces a search once the hand leaves the grip.
    surface.surroundings_signature = 0;
    return surface;
}

std::optional<TriangleHit> cast_palm_ray(const PalmFitter& fitter, const HandTuning& tuning) {
    const PalmFrame& palm = fitter.palm();
    return fitter.placed().mesh->search_bvh.cast_ray(
        palm.center + tuning.ray_back_m * palm.up,
        palm.center - (tuning.ray_length_m - tuning.ray_back_m) * palm.up);
}

// Finds one hand's surface for one frame. `last` is the hand's result of the last frame; its
// triangle is k_none or belongs to the gripped body's mesh.
class GripSearcher {
  public:
    GripSearcher(const HandSurroundings& hand, double dt_s, const Tuning& tuning,
                 const GripSurface& last, GripSearchScratch& scratch)
        : dt_s_(dt_s),
          tuning_(tuning),
          last_(last),
          scratch_(scratch),
          travel_m_(hand_travel_m(last.wrist_bs, hand.wrist_bs)),
          fitter_(hand, hand.wrist_bs, dt_s, tuning.palm),
          search_(fitter_.placed().mesh->search, fitter_.palm(), tuning.palm, scratch) {
        search_.add_seed(last.triangle);
    }

    GripSurface run() {
        const bool is_known = last_.triangle != GripSurface::k_none;
        const double full_search_in_m = last_.full_search_in_m - travel_m_;
        // If following the last surface fails, the full search below restarts the interval.
        double next_full_search_in_m = k_full_search_interval_m;
        if (is_known && full_search_in_m > 0.0 && !fitter_.is_unbudgeted()) {
            search_.run(k_follow_max_idle_pops);
            next_full_search_in_m = full_search_in_m;
            fitter_.reuse_normal(last_.normal_bs);
            if (auto surface = follow_last()) {
                surface->full_search_in_m = full_search_in_m;
                return *surface;
            }
            fitter_.reuse_normal(std::nullopt);
        }
        run_full_search();
        std::optional<GripSurface> surface = is_known ? follow_last() : std::nullopt;
        if (!surface) {
            surface = SurfaceCandidates(fitter_, search_, tuning_.palm, scratch_.patch).run(last_);
        }
        surface->full_search_in_m = next_full_search_in_m;
        return *surface;
    }

  private:
    using Candidate = SurfaceSearch::Candidate;

    void run_full_search() {
        const auto hit = cast_palm_ray(fitter_, tuning_.hand);
        const auto near = fitter_.placed().mesh->search_bvh.closest_point(fitter_.palm().center,
                                                                          tuning_.palm.reach_m);
        search_.add_seed(hit ? hit->triangle : GripSurface::k_none);
        search_.add_seed(near ? near->triangle : GripSurface::k_none);
        search_.run(k_max_idle_pops);
    }

    // Stays on last frame's surface. Returns none if candidates must be evaluated.
    std::optional<GripSurface> follow_last() {
        std::optional<GripSurface> surface;
        if (last_.evaluated_this_frame && !fitter_.is_unbudgeted()) {
            surface = skip_after_evaluation();
        }
        if (!surface && last_.evaluated_count == 0) {
            surface = reuse_candidate();
        }
        if (!surface && last_.evaluated_count == 0) {
            surface = reuse_clearance();
        }
        return surface;
    }

    // Returns `remaining_m` minus this frame's travel. Elapsed time counts as travel, so that a
    // hand at rest is checked again too.
    double travel_left_m(double remaining_m) const {
        constexpr double k_travel_per_time_mps = 0.045;
        constexpr double k_unbudgeted_travel_m = 5e-4;
        const double min_travel_m =
            fitter_.is_unbudgeted() ? k_unbudgeted_travel_m : k_travel_per_time_mps * dt_s_;
        return remaining_m - std::max(travel_m_, min_travel_m);
    }

    // Refines the fit on last frame's surface. Returns none if the surface is out of reach or has
    // lost its clearance.
    std::optional<GripSurface> refine_last() {
        const auto near = fitter_.candidate_near_last(search_, last_);
        if (!near) {
            return std::nullopt;
        }
        const FittedPalm held = fitter_.refine_at(*near, last_);
        if (last_.clearance_recheck_in_m > 0.0 &&
            held.penetration_m > k_palm_penetration_tolerance_m) {
            return std::nullopt;
        }
        GripSurface surface = held.surface;
        surface.clearance_recheck_in_m = std::max(travel_left_m(last_.clearance_recheck_in_m), 0.0);
        return surface;
    }

    // Used if the last frame evaluated candidates: leaves this frame's budget to the digits.
    // Returns none if the surface is out of reach or has lost its clearance.
    std::optional<GripSurface> skip_after_evaluation() {
        constexpr double k_due_next_frame_m = 1e-9;
        std::optional<GripSurface> surface = refine_last();
        if (surface) {
            surface->cost_m = last_.cost_m;
            surface->candidates = last_.candidates;
            surface->evaluated_count = last_.evaluated_count;
            surface->candidate_count = last_.candidate_count;
            surface->allows_backfaces = last_.allows_backfaces;
            surface->pending_finger_samples = last_.pending_finger_samples;
            surface->candidate_recheck_in_m =
                last_.candidate_recheck_in_m > 0.0
                    ? std::max(travel_left_m(last_.candidate_recheck_in_m), k_due_next_frame_m)
                    : 0.0;
        }
        return surface;
    }

    // Keeps the chosen candidate until its recheck is due: evaluation is expensive, and its result
    // rarely changes nearby. Returns none if the recheck is due.
    std::optional<GripSurface> reuse_candidate() {
        const double remaining_m = travel_left_m(last_.candidate_recheck_in_m);
        std::optional<GripSurface> surface;
        if (remaining_m > 0.0) {
            surface = refine_last();
        }
        if (surface) {
            surface->candidate_recheck_in_m = remaining_m;
        }
        return surface;
    }

    // Keeps a surface with clearance while it still has the lowest closed-form cost. Returns none
    // if its clearance must be checked.
    std::optional<GripSurface> reuse_clearance() {
        const double remaining_m = travel_left_m(last_.clearance_recheck_in_m);
        const auto cheapest = search_.cheapest_excluding({});
        if (remaining_m <= 0.0 || !cheapest || !fitter_.is_near_last(*cheapest, last_)) {
            return std::nullopt;
        }
        const FittedPalm held = fitter_.refine_at(*cheapest, last_);
        if (held.penetration_m > k_palm_penetration_tolerance_m) {
            return std::nullopt;
        }
        GripSurface surface = held.surface;
        surface.clearance_recheck_in_m = remaining_m;
        return surface;
    }

    double dt_s_;
    const Tuning& tuning_;
    const GripSurface& last_;
    GripSearchScratch& scratch_;
    double travel_m_;  // travel of the hand since the last frame
    PalmFitter fitter_;
    SurfaceSearch search_;
};

// Returns last frame's surface; a default one if it was on another body or its triangle no longer
// exists.
GripSurface valid_last_surface(const HandSurroundings& hand, const GripSurface& surface) {
    const std::size_t triangles = hand.meshes.front().mesh->search.triangles.size();
    return surface.body == hand.body && surface.triangle < triangles ? surface : GripSurface{};
}

}  // namespace

void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats) {
    for (const HandSurroundings& hand : io.hands) {
        GripSurface& surface = io.surface.at(hand.hand);
        if (is_null(hand.body) || hand.meshes.empty()) {
            surface = {};
            continue;
        }
        if (hand.authored != nullptr) {
            const bool is_known = surface.body == hand.body &&
                                  surface.surroundings_signature == 0 &&
                                  hand_travel_m(surface.wrist_bs, hand.authored->wrist_bs) == 0.0;
            if (!is_known) {
                surface = authored_grip_surface(hand, io.dt_s, tuning.palm);
            }
            continue;
        }
        const bool is_evaluation_due =
            surface.evaluated_count > 0 || (surface.candidate_recheck_in_m > 0.0 &&
                                            surface.candidate_recheck_in_m < k_recheck_interval_m);
        const bool is_refinement_due = !surface.is_converged && surface.stationary_refine_frames <
                                                                    k_max_stationary_refine_frames;
        const bool is_stationary =
            surface.surroundings_signature == hand.signature &&
            surface.triangle != GripSurface::k_none &&
            hand_travel_m(surface.wrist_bs, hand.wrist_bs) < tuning.finger.reuse_travel_m;
        if (is_stationary && !is_evaluation_due && !is_refinement_due) {
            surface.evaluated_this_frame = false;
            continue;
        }
        // Frames of a running candidate search do not count: the best candidate is refined
        // afterwards.
        const std::uint32_t refined = surface.evaluated_count > 0 ? 0 : 1;
        const std::uint32_t refine_frames =
            is_stationary ? surface.stationary_refine_frames + refined : 0;
        const GripSurface last = valid_last_surface(hand, surface);
        surface = GripSearcher(hand, io.dt_s, tuning, last, io.scratch).run();
        surface.stationary_refine_frames = refine_frames;
        if (surface.triangle == GripSurface::k_none) {
            stats.count(Fallback::palm_no_surface);
        }
    }
}

}  // namespace handhold
