#include "tools/lab/grip_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/authored_grip.hpp"
#include "components/tracking.hpp"
#include "engine/core/profile.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/sweep_fingers.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::lab {
namespace {

constexpr double k_at_once_s = std::numeric_limits<double>::infinity();
constexpr double k_frame_s = 1.0 / 90.0;

// The talk's method does not depenetrate the palm, so its rig has no palm capsules.
HandRig fitted_rig(const HandRig& rig, FingerMethod fingers) {
    HandRig fitted = rig;
    if (fingers == FingerMethod::talk) {
        fitted.palm.clear();
    }
    return fitted;
}

// The baselines treat a thumb like any other finger, at a fixed opposition.
double resting_opposition(const FingerRig& finger, const ThumbTuning& tuning) {
    return finger.name == FingerName::thumb
               ? std::clamp(tuning.rest_opposition_rad, finger.lower_opposition_rad,
                            finger.upper_opposition_rad)
               : 0.0;
}

// The columns of one hand, and the scratch memory of its stages.
class OneHand {
  public:
    OneHand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist, FingerMethod fingers)
        : mesh_(mesh), rig_(fitted_rig(rig, fingers)) {
        const Entity hand = entities_.create();
        const Entity body = entities_.create();
        tracking_.add(hand).pressed = true;
        surface_.add(hand);
        offset_.add(hand);
        palm_.add(hand);
        fingers_.add(hand);
        surroundings_.push_back({.hand = hand,
                                 .body = body,
                                 .rig = &rig_,
                                 .body_ws = {},
                                 .wrist_bs = wrist,
                                 .meshes = {{&mesh, {}}},
                                 .signature = 1,
                                 .search_signature = 1,
                                 .is_gripping = true});
    }
    OneHand(const OneHand&) = delete;
    OneHand& operator=(const OneHand&) = delete;

    void run(const Tuning& tuning, const GripVariant& variant, GripTimes& us) {
        timed(us.search_us, [&] { search(tuning, variant); });
        timed(us.palm_us, [&] { constrain(variant); });
        timed(us.fingers_us, [&] { close(tuning, variant); });
        timed(us.fit_us, [&] { fit(k_at_once_s, tuning, variant); });
        for (std::uint32_t i = 0; i < k_thumb_tries; ++i) {
            timed(us.later_us, [&] { fit(k_at_once_s, tuning, variant); });
        }
    }

    // The shown hand in the frames in which it closes.
    void run_in_play(const Tuning& tuning, const GripVariant& variant) {
        tracking_.elements().front().pressed = false;
        surroundings_.front().is_gripping = false;
        fit(k_at_once_s, tuning, variant);
        tracking_.elements().front().pressed = true;
        surroundings_.front().is_gripping = true;
        for (int frame = 0; frame < variant.shown_after; ++frame) {
            run_frame_us(tracked_wrist(), tuning, variant);
        }
    }

    // Runs one frame that reuses the previous frame's results. Returns its time in microseconds.
    double run_frame_us(const Pose& wrist, const Tuning& tuning, const GripVariant& variant) {
        surroundings_.front().wrist_bs = wrist;
        traces_.front() = {};
        double us = 0.0;
        timed(us, [&] {
            search(tuning, variant);
            constrain(variant);
            close(tuning, variant);
            fit(k_frame_s, tuning, variant);
        });
        return us;
    }

    const GripSurface& surface() const { return surface_.elements().front(); }
    const Pose& tracked_wrist() const { return surroundings_.front().wrist_bs; }
    const Pose& wrist() const { return palm_.elements().front().pose_ws; }
    const FingerPose& fingers() const { return fingers_.elements().front(); }
    const PalmOffset& offset() const { return offset_.elements().front(); }
    const std::array<FingerTrace, k_finger_count>& traces() const { return traces_.front(); }

  private:
    template <typename Stages>
    static void timed(double& sum_us, const Stages& stages) {
        const std::int64_t begin_ns = stage_now_ns();
        stages();
        sum_us += 1e-3 * static_cast<double>(stage_now_ns() - begin_ns);
    }

    void search(const Tuning& tuning, const GripVariant& variant) {
        if (variant.palm == PalmChoice::ray_only) {
            choose_by_palm_ray(tuning);
        } else {
            search_grip({.hands = surroundings_, .surface = surface_, .scratch = search_scratch_},
                        tuning, stats_);
        }
    }
    // Keeps the surface of a hand at rest, as search_grip does.
    void choose_by_palm_ray(const Tuning& tuning) {
        const HandSurroundings& hand = surroundings_.front();
        GripSurface& surface = surface_.elements().front();
        if (has_surface() &&
            hand_travel_m(surface.wrist_bs, hand.wrist_bs) < tuning.finger.reuse_travel_m) {
            return;
        }
        const PalmFitter fitter(hand, hand.wrist_bs, tuning.palm);
        const PalmFrame& palm = fitter.palm();
        const auto hit = mesh_.search_bvh.cast_ray(
            palm.center + tuning.hand.ray_back_m * palm.up,
            palm.center - (tuning.hand.ray_length_m - tuning.hand.ray_back_m) * palm.up);
        surface = hit ? fitter.fit({hit->triangle, hit->point, 0.0}).surface : GripSurface{};
    }
    static bool is_fitted(const GripVariant& variant) {
        return variant.fingers == FingerMethod::fit && variant.sync;
    }
    bool has_surface() const { return surface_.elements().front().triangle != GripSurface::k_none; }

    void constrain(const GripVariant& variant) {
        constrain_palms({.hands = surroundings_, .surface = surface_, .offset = offset_});
        PalmOffset& offset = offset_.elements().front();
        if (!variant.sync) {
            offset.held_m = Vec3::Zero();
            offset.held_turn_rad = Vec3::Zero();
        }
        palm_.elements().front().pose_ws = held_wrist_bs(surroundings_.front(), offset);
    }
    void close(const Tuning& tuning, const GripVariant& variant) {
        const bool is_baseline =
            variant.fingers == FingerMethod::talk || variant.fingers == FingerMethod::spheres;
        if (!is_baseline || !has_surface()) {
            sweep_fingers({.hands = surroundings_,
                           .surface = surface_,
                           .offset = offset_,
                           .fingers = fingers_,
                           .traces = traces_,
                           .scratch = fit_scratch_},
                          tuning, stats_);
            return;
        }
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            close_baseline(f, tuning, variant);
        }
    }
    // Baselines and hands without sync have no fit: the palm stays where constrain() has put it,
    // and the fingers are shown as close() has left them.
    void fit(double dt_s, const Tuning& tuning, const GripVariant& variant) {
        FingerPose& pose = fingers_.elements().front();
        if (is_fitted(variant) || !has_surface()) {
            fit_hands({.dt_s = dt_s,
                       .hands = surroundings_,
                       .hand = tracking_,
                       .surface = surface_,
                       .offset = offset_,
                       .fingers = fingers_,
                       .palm = palm_},
                      tuning, stats_);
        } else {
            pose.shown = pose.closed;
            pose.target = pose.closed;
        }
    }
    void close_baseline(std::size_t f, const Tuning& tuning, const GripVariant& variant) {
        const FingerRig& finger = rig_.fingers[f];
        FingerAngles& angles = fingers_.elements().front().closed[f];
        angles.opposition_rad = resting_opposition(finger, tuning.thumb);
        const HingeChain chain = finger_chain(finger, angles.opposition_rad, wrist());
        const GripSurface& seed_under_palm = surface();
        const ClosedFinger closed =
            variant.fingers == FingerMethod::talk
                ? close_by_talk(chain, mesh_, {seed_under_palm.triangle, seed_under_palm.point_bs},
                                variant.order, fit_scratch_)
                : close_by_spheres(chain, mesh_);
        angles.curl_rad = closed.angle_rad;
        const bool touches = closed.contact_link != DiscClosure::k_none;
        traces_.front()[f] = {closed.discs,
                              closed.pops,
                              closed.walked,
                              closed.contact_link,
                              touches ? ChainFallback::none : ChainFallback::rest_pose,
                              0.0};
    }
    const GripMesh& mesh_;
    const HandRig rig_;
    EntityPool entities_;
    Column<HandTracking> tracking_;
    Column<GripSurface> surface_;
    Column<PalmOffset> offset_;
    Column<PalmPose> palm_;
    Column<FingerPose> fingers_;
    std::vector<HandSurroundings> surroundings_;
    std::vector<std::array<FingerTrace, k_finger_count>> traces_{1};
    GripSearchScratch search_scratch_;
    ChainFitScratch fit_scratch_;
    StageStats stats_;
};

void count_jumps(const HandRig& rig, const FingerPose& before, const FingerPose& after,
                 WarmHand& warm) {
    constexpr double k_jump_rad = std::numbers::pi / 18.0;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            const double way_rad = after.target[f].curl_rad[i] - before.target[f].curl_rad[i];
            const double shown_rad = after.shown[f].curl_rad[i] - before.shown[f].curl_rad[i];
            ++warm.joint_frames;
            warm.jumps += std::abs(way_rad) >= k_jump_rad ? 1U : 0U;
            warm.shown_jumps += std::abs(shown_rad) >= k_jump_rad ? 1U : 0U;
        }
    }
}

void add_pops(const std::array<FingerTrace, k_finger_count>& traces, WarmHand& warm) {
    for (const FingerTrace& trace : traces) {
        if (trace.discs > 0) {
            warm.pops.push_back((trace.pops + trace.discs - 1) / trace.discs);
        }
    }
}

// Writes the shown hand to `posed`.
void describe(const OneHand& hand, const GripMesh& mesh, const HandRig& rig, PosedHand& posed) {
    posed.gripped = hand.surface().triangle != GripSurface::k_none;
    posed.reason = posed.gripped ? "" : "no_surface";
    posed.wrist = hand.wrist();
    const GripSync sync = grip_sync(hand.tracked_wrist(), hand.wrist(), rig.palm_center_hs);
    posed.sync_m = sync.palm_m;
    posed.sync_rad = sync.turn_rad;
    if (posed.gripped) {
        posed.point = hand.surface().point_bs;
        posed.normal = hand.surface().normal_bs;
        posed.triangle = mesh.search.source_triangle[hand.surface().triangle];
        constexpr double k_anywhere_m = 1.0;
        if (const auto near = mesh.contact_bvh.closest_point(posed.point, k_anywhere_m)) {
            posed.triangle = mesh.contact.source_triangle[near->triangle];
        }
    }
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        posed.angles[f] = hand.fingers().shown[f];
        posed.traces[f] = hand.traces()[f];
    }
}

}  // namespace

PosedHand pose_cold_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                         const Tuning& tuning, const GripVariant& variant) {
    OneHand hand(mesh, rig, wrist, variant.fingers);
    PosedHand posed;
    if (variant.shown_after > 0) {
        hand.run_in_play(tuning, variant);
    } else {
        hand.run(tuning, variant, posed.us);
    }
    describe(hand, mesh, rig, posed);
    return posed;
}

WarmHand move_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                   const Tuning& tuning, const GripVariant& variant, std::span<const Pose> motion) {
    OneHand hand(mesh, rig, wrist, variant.fingers);
    GripTimes cold;
    hand.run(tuning, variant, cold);
    WarmHand warm;
    if (hand.surface().triangle == GripSurface::k_none) {
        return warm;
    }
    Pose at = wrist;
    for (const Pose& moved : motion) {
        at = wrist * (rig.side == HandSide::left ? mirror_hand_pose(moved) : moved);
        const FingerPose before = hand.fingers();
        warm.moving_us.push_back(hand.run_frame_us(at, tuning, variant));
        count_jumps(rig, before, hand.fingers(), warm);
        add_pops(hand.traces(), warm);
    }
    describe(hand, mesh, rig, warm.moved);
    // Lets the shown hand converge before measuring a hand that stands still.
    constexpr int k_convergence_frames = 45;
    for (int frame = 0; frame < k_convergence_frames; ++frame) {
        hand.run_frame_us(at, tuning, variant);
    }
    for (std::size_t frame = 0; frame < motion.size(); ++frame) {
        warm.stand_us.push_back(hand.run_frame_us(at, tuning, variant));
    }
    return warm;
}

}  // namespace handhold::lab
