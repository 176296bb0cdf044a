#include "systems/hand/pose_thumb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/geometry/chain_refit.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

constexpr double k_max_tip_gap_m = 0.05;

// Gap between the fingertip and the nearest surface, at most k_max_tip_gap_m.
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

struct ThumbFit {
    double cost_m = std::numeric_limits<double>::infinity();
    double opposition_rad = 0.0;
    ChainFit fit;
};

// Fits one thumb at a time. A new grip starts a search over all opposition angles, a few per frame.
// Afterwards the last fit is updated every frame. While that fit penetrates or touches nothing,
// other opposition angles are evaluated one at a time, with a back-off.
class ThumbPoser {
  public:
    ThumbPoser(const PoseThumbIo& io, const Tuning& tuning, SearchOrder order, StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {
        settings_.order = order;
    }

    void pose(std::size_t hand_index, std::size_t f) {
        const HandSurroundings& hand = io_.hands[hand_index];
        FingerPose& pose = io_.fingers.at(hand.hand);
        const FingerRig& thumb = hand.rig->fingers[f];
        const bool was_pending = std::exchange(pose.thumb_refit_pending, false);
        if (io_.surface.at(hand.hand).triangle == GripSurface::k_none) {
            set_rest_pose(thumb, !hand.is_gripping && io_.hand.at(hand.hand).pressed,
                          pose.target[f]);
            if (const auto authored = authored_angles(hand, thumb)) {
                pose.target[f] = *authored;
            }
            pose.thumb_solved = false;
            pose.thumb_search = {};
            pose.backoff[f].queued_frames = 0;
            return;
        }
        if (pose.thumb_solved && pose.thumb_converged &&
            is_same_pose(pose.thumb_wrist_bs, pose.solved_wrist_bs)) {
            return;
        }
        if (take_authored_pose(hand, thumb, pose, f) || defer_to_fingers(hand, f, pose)) {
            return;
        }
        const ThumbFit best = fit_thumb(hand, thumb, f, was_pending, pose);
        pose.target[f] = {best.fit.angle_rad, best.opposition_rad};
        if (best.fit.contact_triangle != k_no_triangle) {
            pose.seed_triangle[f] = best.fit.contact_triangle;
        }
        pose.thumb_wrist_bs = pose.solved_wrist_bs;
        pose.thumb_solved = true;
        pose.thumb_converged = !(is_good_fit(best.fit) ? best.fit.is_turn_limited
                                                       : pose.backoff[f].travel_since_m > 0.0);
        lift_palm(hand, f, best.fit.depth_m, pose);
        if (best.fit.fallback == ChainFallback::rest_pose) {
            stats_.count(Fallback::finger_no_contact);
        }
        if (!io_.traces.empty()) {
            io_.traces[hand_index][f] = {best.fit.discs,    best.fit.pops,
                                         best.fit.walked,   best.fit.contact_link,
                                         best.fit.fallback, best.fit.depth_m};
        }
    }

  private:
    // An opposition step and its two neighbours.
    static constexpr std::uint32_t k_neighbour_steps = 3;

    static std::optional<FingerAngles> authored_angles(const HandSurroundings& hand,
                                                       const FingerRig& thumb) {
        return hand.authored != nullptr ? posed_angles(thumb, *hand.authored) : std::nullopt;
    }

    // Takes the thumb's authored pose unless it penetrates. Returns true if it was taken.
    bool take_authored_pose(const HandSurroundings& hand, const FingerRig& thumb, FingerPose& pose,
                            std::size_t f) {
        const auto posed = authored_angles(hand, thumb);
        if (!posed) {
            pose.authored_pose_rejected[f] = false;
            return false;
        }
        const HingeChain chain = finger_chain(thumb, posed->opposition_rad, pose.solved_wrist_bs);
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch.patch) >
            tuning_.finger.search_depth_m) {
            count_rejected_pose(io_.offset.at(hand.hand), f, pose, stats_);
            return false;
        }
        pose.authored_pose_rejected[f] = false;
        pose.target[f] = *posed;
        pose.thumb_wrist_bs = pose.solved_wrist_bs;
        pose.thumb_solved = true;
        pose.thumb_converged = true;
        pose.thumb_search = {};
        pose.backoff[f].queued_frames = 0;
        return true;
    }

    // Returns true if the thumb must wait because fingers are queued for their first fit: the thumb
    // closes last. Waits at most 4 frames, because the queue of a fast hand never empties.
    static bool defer_to_fingers(const HandSurroundings& hand, std::size_t thumb,
                                 FingerPose& pose) {
        constexpr std::uint32_t k_max_frames = 4;
        bool has_queued_finger = false;
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            has_queued_finger =
                has_queued_finger || (f != thumb && pose.backoff[f].queued_frames > 0);
        }
        std::uint32_t& queued_frames = pose.backoff[thumb].queued_frames;
        const bool is_deferred =
            has_queued_finger && !pose.thumb_solved && queued_frames < k_max_frames;
        queued_frames = is_deferred ? queued_frames + 1 : 0;
        return is_deferred;
    }

    // True if the thumb touches a surface and does not penetrate. Otherwise another opposition may
    // be better.
    bool is_good_fit(const ChainFit& fit) const {
        return fit.depth_m <= settings_.open_depth_m && fit.fallback != ChainFallback::rest_pose &&
               !is_bent_clear(fit);
    }

    void lift_palm(const HandSurroundings& hand, std::size_t f, double depth_m, FingerPose& pose) {
        if (pose.backoff[f].retry_in_m > 0.0 &&
            lift_if_penetrating(hand, depth_m, tuning_.palm, io_.offset.at(hand.hand))) {
            stats_.count(Fallback::palm_lifted);
            if (lifts_within_frame(tuning_.palm, io_.dt_s)) {
                pose.solved = false;
                pose.thumb_solved = false;
                pose.thumb_search = {};
            }
        }
    }

    double rest_opposition(const FingerRig& thumb) const {
        return std::clamp(tuning_.thumb.rest_opposition_rad, thumb.lower_opposition_rad,
                          std::max(thumb.lower_opposition_rad, thumb.upper_opposition_rad));
    }

    void set_rest_pose(const FingerRig& thumb, bool is_fist, FingerAngles& target) const {
        target.opposition_rad = rest_opposition(thumb);
        for (std::size_t i = 0; i < thumb.link_count; ++i) {
            const double fist =
                thumb.lower_rad[i] + k_fist_curl * (thumb.upper_rad[i] - thumb.lower_rad[i]);
            target.curl_rad[i] = is_fist ? fist : thumb.rest_rad[i];
        }
    }

    static bool is_same_pose(const Pose& a, const Pose& b) {
        return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
    }

    double opposition_at(const FingerRig& thumb, std::uint32_t step) const {
        const double share = steps() > 1 ? static_cast<double>(step) / (steps() - 1) : 0.5;
        return thumb.lower_opposition_rad +
               share * (thumb.upper_opposition_rad - thumb.lower_opposition_rad);
    }

    // Returns the step nearest to an opposition angle.
    std::uint32_t step_at(const FingerRig& thumb, double opposition_rad) const {
        const double range_rad = thumb.upper_opposition_rad - thumb.lower_opposition_rad;
        if (!(range_rad > 0.0)) {
            return 0;
        }
        const double share =
            std::clamp((opposition_rad - thumb.lower_opposition_rad) / range_rad, 0.0, 1.0);
        return static_cast<std::uint32_t>(std::floor(share * (steps() - 1) + 0.5));
    }

    std::uint32_t steps() const {
        return static_cast<std::uint32_t>(std::max(1, tuning_.thumb.opposition_steps));
    }

    // Fits the thumb for this frame. Keeps the opposition angle while the thumb touches without
    // penetrating, and during the back-off after a failed refit.
    ThumbFit fit_thumb(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                       bool was_pending, FingerPose& pose) {
        FingerBackoff& backoff = pose.backoff[f];
        const bool is_new =
            !pose.thumb_solved || !is_small_move(pose.thumb_wrist_bs, pose.solved_wrist_bs);
        if (is_new && !pose.thumb_search.is_running) {
            begin_search(thumb, f, pose);
        }
        if (pose.thumb_search.is_running) {
            return continue_search(hand, thumb, f, pose);
        }
        const double travel_m = hand_travel_m(pose.thumb_wrist_bs, pose.solved_wrist_bs);
        advance(backoff, travel_m, io_.dt_s);
        advance(pose.lookahead[f], travel_m, io_.dt_s);
        const FingerAngles& last = pose.target[f];
        ChainRefitSettings refit;
        refit.max_turn_rad = io_.dt_s * tuning_.finger.close_radps;
        const bool has_budget =
            std::isinf(io_.dt_s) ||
            (!io_.surface.at(hand.hand).evaluated_this_frame && !pose.finger_refit_this_frame);
        refit.has_surface_ahead = has_surface_ahead(pose.lookahead[f], has_budget);
        ThumbFit kept;
        kept.opposition_rad = last.opposition_rad;
        kept.fit = refit_chain(finger_chain(thumb, last.opposition_rad, pose.solved_wrist_bs),
                               last.curl_rad, hand.meshes, settings_, refit, io_.scratch);
        update_lookahead(kept.fit, pose.lookahead[f]);
        const bool is_acceptable =
            touches(kept.fit) && kept.fit.depth_m <= tuning_.finger.fast_refit_depth_m;
        if (is_good_fit(kept.fit) || (!is_slow(pose) && is_acceptable)) {
            backoff.failures = backoff.retry_in_m <= 0.0 ? 0 : backoff.failures;
            return kept;
        }
        // The thumb gets the next refit if a finger used this frame's, or if it was pending already
        // and a candidate evaluation used this frame.
        pose.thumb_refit_pending =
            is_retry_due(backoff) && !has_budget && (pose.finger_refit_this_frame || was_pending);
        if (!is_retry_due(backoff) || !has_budget) {
            return kept;
        }
        return refit_if_better(hand, thumb, f, kept, pose);
    }

    // Evaluates one other opposition step, and changes to it if it is better. The next call
    // evaluates the next nearest step.
    ThumbFit refit_if_better(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                             const ThumbFit& kept, FingerPose& pose) {
        const bool is_penetrating = kept.fit.depth_m > settings_.open_depth_m;
        const std::uint32_t option_count =
            is_penetrating ? steps() : std::min(steps(), k_neighbour_steps);
        FingerBackoff& backoff = pose.backoff[f];
        const bool slow_hand = is_slow(pose);
        if (slow_hand && backoff.was_fast_hand) {
            backoff.failures = 0;  // evaluates every step again with a slow hand's settings
        }
        const std::uint32_t kept_step = step_at(thumb, kept.opposition_rad);
        const std::uint32_t step = nearest_step(kept_step, backoff.failures % option_count);
        const ChainFitSettings saved_settings = std::exchange(
            settings_, sliding_refit_settings(settings_, kept.fit.angle_rad, slow_hand));
        ThumbFit refitted =
            fit_at_opposition(hand, thumb, opposition_at(thumb, step), pose.seed_triangle[f]);
        settings_ = saved_settings;
        const bool changes =
            is_good_fit(refitted.fit) ||
            (is_penetrating && is_clearly_better(refitted.fit, kept.fit, settings_));
        const double travel_since_m = backoff.travel_since_m;
        record_attempt(backoff, !is_good_fit(refitted.fit), !slow_hand, option_count);
        if (!changes) {
            return kept;
        }
        if (!is_good_fit(refitted.fit) && step != kept_step) {
            backoff.failures = 1;  // the neighbours of the new step come next
            backoff.travel_since_m = travel_since_m;
        }
        begin_transition(refitted.fit.angle_rad, f, pose);
        pose.lookahead[f] = {};
        // Marks the fit as not converged: hinges that nothing stopped close further in the next
        // frame.
        refitted.fit.is_turn_limited = true;
        return refitted;
    }

    // Returns the step that is the `rank`th nearest to `step`; rank 0 is `step` itself.
    std::uint32_t nearest_step(std::uint32_t step, std::uint32_t rank) const {
        const std::uint32_t last = steps() - 1;
        step = std::min(step, last);
        if (rank-- == 0) {
            return step;
        }
        for (std::uint32_t distance = 1; distance <= last; ++distance) {
            if (step + distance <= last && rank-- == 0) {
                return step + distance;
            }
            if (step >= distance && rank-- == 0) {
                return step - distance;
            }
        }
        return step;
    }

    void begin_search(const FingerRig& thumb, std::size_t f, FingerPose& pose) const {
        const double from_rad =
            pose.thumb_solved ? pose.target[f].opposition_rad : rest_opposition(thumb);
        pose.backoff[f] = {};
        pose.lookahead[f] = {};
        pose.thumb_search = {};
        pose.thumb_search.is_running = true;
        pose.thumb_search.may_end_early = pose.thumb_solved;
        pose.thumb_search.start_step = step_at(thumb, from_rad);
    }

    // Evaluates the next few opposition steps of the running search, the one nearest to its start
    // first. If the thumb was fitted before, the search ends after the neighbouring steps if the
    // best fit is clear.
    ThumbFit continue_search(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                             FingerPose& pose) {
        constexpr double k_verify_travel_m = 1e-3;
        ThumbSearch& search = pose.thumb_search;
        ThumbFit best = resume_best(pose, f);
        const std::uint32_t seed = pose.seed_triangle[f];
        settings_.depenetrates = false;
        for (std::uint32_t left = max_evaluations(); left > 0 && !is_done(search, best); --left) {
            const std::uint32_t step = nearest_step(search.start_step, search.evaluated_count);
            keep_better(evaluate_opposition(hand, thumb, opposition_at(thumb, step), seed), best);
            ++search.evaluated_count;
        }
        settings_.depenetrates = true;
        search.cost_m = best.cost_m;
        search.needs_depenetration = best.fit.needs_depenetration;
        search.is_running = !is_done(search, best);
        if (!std::isinf(io_.dt_s)) {
            // Marks the fit as not converged. The next frame refits the thumb at the best
            // opposition, this time with depenetration.
            best.fit.is_turn_limited = true;
            pose.backoff[f].travel_since_m = k_verify_travel_m;
            return best;
        }
        if (best.fit.needs_depenetration) {
            ThumbFit depenetrated = evaluate_opposition(hand, thumb, best.opposition_rad, seed);
            add_visits(best.fit, depenetrated.fit);
            best = depenetrated;
        }
        // Counts as one attempt with one option, because every opposition was evaluated.
        record_attempt(pose.backoff[f], !is_good_fit(best.fit), false);
        return best;
    }

    static ThumbFit resume_best(const FingerPose& pose, std::size_t f) {
        ThumbFit best;
        if (pose.thumb_search.evaluated_count > 0) {
            best.cost_m = pose.thumb_search.cost_m;
            best.opposition_rad = pose.target[f].opposition_rad;
            best.fit.angle_rad = pose.target[f].curl_rad;
            best.fit.needs_depenetration = pose.thumb_search.needs_depenetration;
        }
        return best;
    }

    bool is_done(const ThumbSearch& search, const ThumbFit& best) const {
        const bool ends_early = search.may_end_early &&
                                search.evaluated_count >= k_neighbour_steps &&
                                !best.fit.needs_depenetration;
        return search.evaluated_count >= steps() || ends_early;
    }

    std::uint32_t max_evaluations() const {
        return std::isinf(io_.dt_s)
                   ? steps()
                   : static_cast<std::uint32_t>(std::max(1, tuning_.thumb.evaluations_per_frame));
    }

    // Keeps the fit of lower cost and adds up the search counters of both fits.
    static void keep_better(ThumbFit candidate, ThumbFit& best) {
        if (candidate.cost_m < best.cost_m) {
            std::swap(candidate, best);
        }
        add_visits(candidate.fit, best.fit);
    }

    static void add_visits(const ChainFit& other, ChainFit& fit) {
        fit.discs += other.discs;
        fit.pops += other.pops;
        fit.walked += other.walked;
    }

    ThumbFit fit_at_opposition(const HandSurroundings& hand, const FingerRig& thumb,
                               double opposition_rad, std::uint32_t last_triangle) const {
        const Pose& wrist_bs = io_.fingers.at(hand.hand).solved_wrist_bs;
        const HingeChain chain = finger_chain(thumb, opposition_rad, wrist_bs);
        const ChainSeed seed =
            settings_.searches ? chain_seed(hand, io_.surface.at(hand.hand), last_triangle, chain)
                               : ChainSeed{};
        ThumbFit closed;
        closed.opposition_rad = opposition_rad;
        closed.fit = fit_chain(chain, hand.meshes, seed, settings_, io_.scratch);
        return closed;
    }

    // Like fit_at_opposition, and computes the fit's cost (equation in pose_thumb.hpp).
    ThumbFit evaluate_opposition(const HandSurroundings& hand, const FingerRig& thumb,
                                 double opposition_rad, std::uint32_t last_triangle) const {
        ThumbFit candidate = fit_at_opposition(hand, thumb, opposition_rad, last_triangle);
        const Pose& wrist_bs = io_.fingers.at(hand.hand).solved_wrist_bs;
        const HingeChain chain = finger_chain(thumb, opposition_rad, wrist_bs);
        const auto capsules = chain_capsules(chain, candidate.fit.angle_rad);
        candidate.cost_m =
            tuning_.thumb.penetration_cost * candidate.fit.depth_m +
            (touches(candidate.fit) ? 0.0 : tuning_.thumb.open_cost_m) +
            tuning_.thumb.tip_gap_cost * tip_gap_m(capsules[chain.link_count - 1], hand.meshes) +
            tuning_.thumb.opposition_cost_m_per_rad *
                std::abs(opposition_rad - rest_opposition(thumb));
        return candidate;
    }

    const PoseThumbIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
};

}  // namespace

void pose_thumb(const PoseThumbIo& io, const Tuning& tuning, StageStats& stats, SearchOrder order) {
    ThumbPoser poser(io, tuning, order, stats);
    for (std::size_t hand_index = 0; hand_index < io.hands.size(); ++hand_index) {
        const HandSurroundings& hand = io.hands[hand_index];
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (hand.rig->fingers[f].name == FingerName::thumb) {
                poser.pose(hand_index, f);
                follow_target(f, io.dt_s, tuning.finger, io.fingers.at(hand.hand));
            }
        }
    }
}

}  // namespace handhold
