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

constexpr double k_gap_seen_m = 0.05;  // a tip farther from every surface counts as this far

double tip_gap_m(const Capsule& tip, std::span<const PlacedMesh> meshes) {
    double gap_m = k_gap_seen_m;
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

class ThumbPoser {
  public:
    ThumbPoser(const PoseThumbIo& io, const Tuning& tuning, SearchOrder order, StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {
        settings_.order = order;
    }

    void pose(std::size_t place, std::size_t f) {
        const HandSurroundings& hand = io_.hands[place];
        FingerPose& pose = io_.fingers.at(hand.hand);
        const FingerRig& thumb = hand.rig->fingers[f];
        const bool waited = std::exchange(pose.thumb_waits, false);
        if (io_.surface.at(hand.hand).triangle == GripSurface::k_none) {
            rest(thumb, !hand.grips && io_.hand.at(hand.hand).pressed, pose.target[f]);
            if (const auto posed = posed_in(hand, thumb)) {
                pose.target[f] = *posed;
            }
            pose.thumb_solved = false;
            pose.thumb_search = {};
            pose.retry[f].queued = 0;
            return;
        }
        if (pose.thumb_solved && pose.thumb_arrived &&
            same_place(pose.thumb_wrist_bs, pose.solved_wrist_bs)) {
            return;
        }
        if (take_posed(hand, thumb, pose, f) || waits_for_fingers(hand, f, pose)) {
            return;
        }
        const ThumbFit best = fit_thumb(hand, thumb, f, waited, pose);
        pose.target[f] = {best.fit.angle_rad, best.opposition_rad};
        if (best.fit.contact_triangle != k_no_triangle) {
            pose.seed_triangle[f] = best.fit.contact_triangle;
        }
        pose.thumb_wrist_bs = pose.solved_wrist_bs;
        pose.thumb_solved = true;
        pose.thumb_arrived =
            !(is_well(best.fit) ? best.fit.is_on_its_way : pose.retry[f].since_m > 0.0);
        lift(hand, f, best.fit.depth_m, pose);
        if (best.fit.fallback == ChainFallback::relaxed) {
            stats_.count(Fallback::finger_touches_nothing);
        }
        if (!io_.traces.empty()) {
            io_.traces[place][f] = {best.fit.discs,        best.fit.pops,     best.fit.walked,
                                    best.fit.contact_link, best.fit.fallback, best.fit.depth_m};
        }
    }

  private:
    static constexpr std::uint32_t k_beside = 3;  // an opposition's step and those beside it

    static std::optional<FingerAngles> posed_in(const HandSurroundings& hand,
                                                const FingerRig& thumb) {
        return hand.authored != nullptr ? posed_angles(thumb, *hand.authored) : std::nullopt;
    }

    // As an authored grip has it, where it has it so that it is not sunk.
    bool take_posed(const HandSurroundings& hand, const FingerRig& thumb, FingerPose& pose,
                    std::size_t f) {
        const auto posed = posed_in(hand, thumb);
        if (!posed) {
            pose.pose_refused[f] = false;
            return false;
        }
        const HingeChain chain = finger_chain(thumb, posed->opposition_rad, pose.solved_wrist_bs);
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch.patch) >
            tuning_.finger.search_depth_m) {
            count_refusal(io_.offset.at(hand.hand), f, pose, stats_);
            return false;
        }
        pose.pose_refused[f] = false;
        pose.target[f] = *posed;
        pose.thumb_wrist_bs = pose.solved_wrist_bs;
        pose.thumb_solved = true;
        pose.thumb_arrived = true;
        pose.thumb_search = {};
        pose.retry[f].queued = 0;
        return true;
    }

    // At first fingers are closed, a few in each frame, and then the thumb; but where they have no
    // end, since the hand is fast, it has its turn beside them.
    static bool waits_for_fingers(const HandSurroundings& hand, std::size_t thumb,
                                  FingerPose& pose) {
        constexpr std::uint32_t k_most_frames = 4;
        bool is_queue = false;
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            is_queue = is_queue || (f != thumb && pose.retry[f].queued > 0);
        }
        std::uint32_t& queued = pose.retry[thumb].queued;
        const bool waits = is_queue && !pose.thumb_solved && queued < k_most_frames;
        queued = waits ? queued + 1 : 0;
        return waits;
    }

    // As a thumb should be: else another opposition may do better.
    bool is_well(const ChainFit& fit) const {
        return fit.depth_m <= settings_.open_depth_m && fit.fallback != ChainFallback::relaxed &&
               !is_bent_away(fit);
    }

    void lift(const HandSurroundings& hand, std::size_t f, double depth_m, FingerPose& pose) {
        if (pose.retry[f].wait_m > 0.0 &&
            lift_if_sunk(hand, depth_m, tuning_.palm, io_.offset.at(hand.hand))) {
            stats_.count(Fallback::palm_lifted);
            if (lifts_at_once(tuning_.palm, io_.dt_s)) {
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

    void rest(const FingerRig& thumb, bool is_fist, FingerAngles& target) const {
        target.opposition_rad = rest_opposition(thumb);
        for (std::size_t i = 0; i < thumb.link_count; ++i) {
            const double fist =
                thumb.lower_rad[i] + k_fist * (thumb.upper_rad[i] - thumb.lower_rad[i]);
            target.curl_rad[i] = is_fist ? fist : thumb.relaxed_rad[i];
        }
    }

    static bool same_place(const Pose& a, const Pose& b) {
        return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
    }

    double opposition_at(const FingerRig& thumb, std::uint32_t step) const {
        const double share = steps() > 1 ? static_cast<double>(step) / (steps() - 1) : 0.5;
        return thumb.lower_opposition_rad +
               share * (thumb.upper_opposition_rad - thumb.lower_opposition_rad);
    }

    // The step nearest to an opposition.
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

    // As long as it touches there and is hardly sunk, a thumb keeps its opposition; and where
    // another was looked for in vain, for a while.
    ThumbFit fit_thumb(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                       bool waited, FingerPose& pose) {
        FingerRetry& retry = pose.retry[f];
        const bool is_new =
            !pose.thumb_solved || !is_moment_later(pose.thumb_wrist_bs, pose.solved_wrist_bs);
        if (is_new && !pose.thumb_search.runs) {
            begin_search(thumb, f, pose);
        }
        if (pose.thumb_search.runs) {
            return go_on(hand, thumb, f, pose);
        }
        const double way_m = hand_way_m(pose.thumb_wrist_bs, pose.solved_wrist_bs);
        age(retry, way_m, io_.dt_s);
        age(pose.outlook[f], way_m, io_.dt_s);
        const FingerAngles& last = pose.target[f];
        ChainRefitSettings refit;
        refit.most_turn_rad = io_.dt_s * tuning_.finger.close_radps;
        const bool is_turn =
            std::isinf(io_.dt_s) || (!io_.surface.at(hand.hand).was_judged && !pose.finger_tried);
        refit.is_ahead = is_ahead(pose.outlook[f], is_turn);
        ThumbFit kept;
        kept.opposition_rad = last.opposition_rad;
        kept.fit = refit_chain(finger_chain(thumb, last.opposition_rad, pose.solved_wrist_bs),
                               last.curl_rad, hand.meshes, settings_, refit, io_.scratch);
        note_outlook(kept.fit, pose.outlook[f]);
        const bool will_do = touches(kept.fit) && kept.fit.depth_m <= tuning_.finger.slide_depth_m;
        if (is_well(kept.fit) || (!is_slow(pose) && will_do)) {
            retry.tries = retry.wait_m <= 0.0 ? 0 : retry.tries;
            return kept;
        }
        // A judged surface takes the turn of both: whose it was stays.
        pose.thumb_waits = may_retry(retry) && !is_turn && (pose.finger_tried || waited);
        if (!may_retry(retry) || !is_turn) {
            return kept;
        }
        return change_if_better(hand, thumb, f, kept, pose);
    }

    // One opposition at a time: a hand that slides never pays for more in one frame.
    ThumbFit change_if_better(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                              const ThumbFit& kept, FingerPose& pose) {
        const bool is_sunk = kept.fit.depth_m > settings_.open_depth_m;
        const std::uint32_t most = is_sunk ? steps() : std::min(steps(), k_beside);
        FingerRetry& retry = pose.retry[f];
        const bool slow = is_slow(pose);
        if (slow && retry.was_fast) {
            retry.tries = 0;  // all of them once more
        }
        const std::uint32_t kept_step = step_at(thumb, kept.opposition_rad);
        const std::uint32_t step = step_beside(kept_step, retry.tries % most);
        const ChainFitSettings usual =
            std::exchange(settings_, in_a_slide(settings_, kept.fit.angle_rad, slow));
        ThumbFit anew = close_at(hand, thumb, opposition_at(thumb, step), pose.seed_triangle[f]);
        settings_ = usual;
        const bool changes =
            is_well(anew.fit) || (is_sunk && is_clearly_better(anew.fit, kept.fit, settings_));
        const double since_m = retry.since_m;
        note_try(retry, !is_well(anew.fit), !slow, most);
        if (!changes) {
            return kept;
        }
        if (!is_well(anew.fit) && step != kept_step) {
            retry.tries = 1;  // those beside it come next
            retry.since_m = since_m;
        }
        begin_change(anew.fit.angle_rad, f, pose);
        pose.outlook[f] = {};
        anew.fit.is_on_its_way = true;  // hinges that it was stopped by nothing at close on
        return anew;
    }

    // Of all steps the one that is `rank`th nearest to `step`, from 0.
    std::uint32_t step_beside(std::uint32_t step, std::uint32_t rank) const {
        const std::uint32_t last = steps() - 1;
        step = std::min(step, last);
        if (rank-- == 0) {
            return step;
        }
        for (std::uint32_t away = 1; away <= last; ++away) {
            if (step + away <= last && rank-- == 0) {
                return step + away;
            }
            if (step >= away && rank-- == 0) {
                return step - away;
            }
        }
        return step;
    }

    void begin_search(const FingerRig& thumb, std::size_t f, FingerPose& pose) const {
        const double from_rad =
            pose.thumb_solved ? pose.target[f].opposition_rad : rest_opposition(thumb);
        pose.retry[f] = {};
        pose.outlook[f] = {};
        pose.thumb_search = {};
        pose.thumb_search.runs = true;
        pose.thumb_search.is_near = pose.thumb_solved;
        pose.thumb_search.from_step = step_at(thumb, from_rad);
    }

    // The cheapest of all oppositions. A few are tried in each frame, those next to where it stands
    // first; a thumb that was posed before turns by one step at most, as long as it fits there.
    ThumbFit go_on(const HandSurroundings& hand, const FingerRig& thumb, std::size_t f,
                   FingerPose& pose) {
        constexpr double k_once_more_m = 1e-3;
        ThumbSearch& search = pose.thumb_search;
        ThumbFit best = best_so_far(pose, f);
        const std::uint32_t seed = pose.seed_triangle[f];
        settings_.mends = false;
        for (std::uint32_t left = most_tries(); left > 0 && !is_over(search, best); --left) {
            const std::uint32_t step = step_beside(search.from_step, search.tried);
            take_better(try_at(hand, thumb, opposition_at(thumb, step), seed), best);
            ++search.tried;
        }
        settings_.mends = true;
        search.cost_m = best.cost_m;
        search.wants_mending = best.fit.wants_mending;
        search.runs = !is_over(search, best);
        if (!std::isinf(io_.dt_s)) {
            // It is looked at once more in the next frame: what is sunk is mended then.
            best.fit.is_on_its_way = true;
            pose.retry[f].since_m = k_once_more_m;
            return best;
        }
        if (best.fit.wants_mending) {
            ThumbFit mended = try_at(hand, thumb, best.opposition_rad, seed);
            add_visits(best.fit, mended.fit);
            best = mended;
        }
        note_try(pose.retry[f], !is_well(best.fit), false);  // all oppositions
        return best;
    }

    static ThumbFit best_so_far(const FingerPose& pose, std::size_t f) {
        ThumbFit best;
        if (pose.thumb_search.tried > 0) {
            best.cost_m = pose.thumb_search.cost_m;
            best.opposition_rad = pose.target[f].opposition_rad;
            best.fit.angle_rad = pose.target[f].curl_rad;
            best.fit.wants_mending = pose.thumb_search.wants_mending;
        }
        return best;
    }

    bool is_over(const ThumbSearch& search, const ThumbFit& best) const {
        const bool ends_early =
            search.is_near && search.tried >= k_beside && !best.fit.wants_mending;
        return search.tried >= steps() || ends_early;
    }

    std::uint32_t most_tries() const {
        return std::isinf(io_.dt_s)
                   ? steps()
                   : static_cast<std::uint32_t>(std::max(1, tuning_.thumb.tries_per_frame));
    }

    // Keeps the cheaper, and counts what both took.
    static void take_better(ThumbFit tried, ThumbFit& best) {
        if (tried.cost_m < best.cost_m) {
            std::swap(tried, best);
        }
        add_visits(tried.fit, best.fit);
    }

    static void add_visits(const ChainFit& other, ChainFit& fit) {
        fit.discs += other.discs;
        fit.pops += other.pops;
        fit.walked += other.walked;
    }

    ThumbFit close_at(const HandSurroundings& hand, const FingerRig& thumb, double opposition_rad,
                      std::uint32_t last_triangle) const {
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

    // And what it costs.
    ThumbFit try_at(const HandSurroundings& hand, const FingerRig& thumb, double opposition_rad,
                    std::uint32_t last_triangle) const {
        ThumbFit tried = close_at(hand, thumb, opposition_rad, last_triangle);
        const Pose& wrist_bs = io_.fingers.at(hand.hand).solved_wrist_bs;
        const HingeChain chain = finger_chain(thumb, opposition_rad, wrist_bs);
        const auto capsules = chain_capsules(chain, tried.fit.angle_rad);
        tried.cost_m =
            tuning_.thumb.sunk_cost * tried.fit.depth_m +
            (touches(tried.fit) ? 0.0 : tuning_.thumb.open_cost_m) +
            tuning_.thumb.gap_cost * tip_gap_m(capsules[chain.link_count - 1], hand.meshes) +
            tuning_.thumb.turn_cost_m_per_rad * std::abs(opposition_rad - rest_opposition(thumb));
        return tried;
    }

    const PoseThumbIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
};

}  // namespace

void pose_thumb(const PoseThumbIo& io, const Tuning& tuning, StageStats& stats, SearchOrder order) {
    ThumbPoser poser(io, tuning, order, stats);
    for (std::size_t place = 0; place < io.hands.size(); ++place) {
        const HandSurroundings& hand = io.hands[place];
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (hand.rig->fingers[f].name == FingerName::thumb) {
                poser.pose(place, f);
                follow_target(f, io.dt_s, tuning.finger, io.fingers.at(hand.hand));
            }
        }
    }
}

}  // namespace handhold
