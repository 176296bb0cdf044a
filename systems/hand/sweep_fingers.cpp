#include "systems/hand/sweep_fingers.hpp"

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/surface_search.hpp"
#include "systems/hand/shared/thumb_closing.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

// Travel of the held wrist after which a hand in an authored grip closes again. Small, because an
// authored pose is checked at the exact wrist.
constexpr double k_close_again_in_grip_m = 1e-6;

void count_fallback(ChainFallback fallback, StageStats& stats) {
    if (fallback == ChainFallback::all_cuts) {
        stats.count(Fallback::finger_full_search);
    } else if (fallback == ChainFallback::sample_pose) {
        stats.count(Fallback::finger_depenetrated);
    } else if (fallback == ChainFallback::opened) {
        stats.count(Fallback::finger_opened);
    } else if (fallback == ChainFallback::rest_pose) {
        stats.count(Fallback::finger_no_contact);
    }
}

bool is_closing_due(const HandSurroundings& hand, const GripSurface& surface,
                    const Pose& held_wrist_bs, const FingerPose& pose) {
    const bool is_in_grip = hand.authored != nullptr;
    const double travel_m = hand_travel_m(pose.closed_wrist_bs, held_wrist_bs);
    return pose.closed_body != hand.body || pose.is_closed_in_grip != is_in_grip ||
           travel_m > (is_in_grip ? k_close_again_in_grip_m : k_close_again_m) ||
           (!is_in_grip && !is_duplicate_place(surface.point_bs, surface.normal_bs,
                                               pose.closed_point_bs, pose.closed_normal_bs));
}

class FingerCloser {
  public:
    FingerCloser(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {}

    void close(std::size_t hand_index) {
        const HandSurroundings& hand = io_.hands[hand_index];
        const GripSurface& surface = io_.surface.at(hand.hand);
        FingerPose& pose = io_.fingers.at(hand.hand);
        if (surface.triangle == GripSurface::k_none) {
            pose.closed_body = k_no_entity;
            pose.is_newly_closed = false;
            pose.authored_pose_rejected.fill(false);
            take_authored_poses(hand, pose);
            return;
        }
        const Pose wrist_bs = held_wrist_bs(hand, io_.offset.at(hand.hand));
        if (!is_closing_due(hand, surface, wrist_bs, pose)) {
            return;
        }
        if (pose.closed_body != hand.body || hand.authored == nullptr) {
            pose.authored_pose_rejected.fill(false);
        }
        pose.closed_body = hand.body;
        pose.closed_wrist_bs = wrist_bs;
        pose.closed_point_bs = surface.point_bs;
        pose.closed_normal_bs = surface.normal_bs;
        pose.is_closed_in_grip = hand.authored != nullptr;
        pose.is_newly_closed = true;
        // Closes thumbs last, because they stop at fingers.
        for (const bool are_thumbs : {false, true}) {
            for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
                if ((hand.rig->fingers[f].name == FingerName::thumb) != are_thumbs) {
                    continue;
                }
                pose.is_authored[f] = take_authored_pose(hand, wrist_bs, f, pose);
                if (!pose.is_authored[f]) {
                    close_digit(hand_index, wrist_bs, f, pose);
                }
            }
        }
    }

  private:
    // Without a surface to check against, digits take their authored poses unchecked.
    static void take_authored_poses(const HandSurroundings& hand, FingerPose& pose) {
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            const auto posed = hand.authored != nullptr
                                   ? posed_angles(hand.rig->fingers[f], *hand.authored)
                                   : std::nullopt;
            pose.is_authored[f] = posed.has_value();
            if (posed) {
                pose.closed[f] = *posed;
            }
        }
    }

    // Takes the digit's authored pose and returns true, unless that pose penetrates. A rejected
    // pose is counted once per grip.
    bool take_authored_pose(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                            FingerPose& pose) {
        const FingerRig& finger = hand.rig->fingers[f];
        const auto posed =
            hand.authored != nullptr ? posed_angles(finger, *hand.authored) : std::nullopt;
        if (!posed) {
            return false;
        }
        const HingeChain chain = finger_chain(finger, posed->opposition_rad, wrist_bs);
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch.patch) >
            tuning_.finger.search_depth_m) {
            if (!pose.authored_pose_rejected[f]) {
                stats_.count(Fallback::authored_finger_rejected);
            }
            pose.authored_pose_rejected[f] = true;
            return false;
        }
        pose.authored_pose_rejected[f] = false;
        pose.closed[f] = *posed;
        pose.touches[f] = true;
        pose.is_closed_clear[f] = true;
        return true;
    }

    void close_digit(std::size_t hand_index, const Pose& wrist_bs, std::size_t f,
                     FingerPose& pose) {
        const HandSurroundings& hand = io_.hands[hand_index];
        const GripSurface& surface = io_.surface.at(hand.hand);
        const FingerRig& finger = hand.rig->fingers[f];
        ChainFit fit;
        if (finger.name == FingerName::thumb) {
            const DigitCapsules fingers =
                digit_capsules(*hand.rig, link_frames(*hand.rig, {wrist_bs, pose.closed}));
            const ClosedThumb thumb = close_thumb({hand, surface, finger, wrist_bs, fingers},
                                                  settings_, tuning_.thumb, io_.scratch);
            fit = thumb.fit;
            pose.closed[f] = {fit.angle_rad, thumb.opposition_rad};
            pose.touches[f] = thumb.touches;
        } else {
            const HingeChain chain = finger_chain(finger, 0.0, wrist_bs);
            fit = fit_chain(chain, hand.meshes, chain_seed(hand, surface, chain), settings_,
                            io_.scratch);
            pose.closed[f] = {fit.angle_rad, 0.0};
            pose.touches[f] = touches(fit);
        }
        pose.is_closed_clear[f] = fit.depth_m < clear_depth_m(finger);
        count_fallback(fit.fallback, stats_);
        if (!io_.traces.empty()) {
            io_.traces[hand_index][f] = {fit.discs,        fit.pops,     fit.walked,
                                         fit.contact_link, fit.fallback, fit.depth_m};
        }
    }

    const SweepFingersIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
};

}  // namespace

void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats) {
    FingerCloser closer(io, tuning, stats);
    for (std::size_t hand_index = 0; hand_index < io.hands.size(); ++hand_index) {
        closer.close(hand_index);
    }
}

}  // namespace handhold
