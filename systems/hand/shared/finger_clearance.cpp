#include "systems/hand/shared/finger_clearance.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/geometry/hinge_chain.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold {
namespace {

// Curl of the first hinge and of the other hinges, as shares of the range from open to closed. The
// straight pose comes first, because most fingers have clearance in it.
struct SamplePose {
    double first;
    double others;
};
constexpr std::array<SamplePose, 8> k_pose_samples = {{{0.0, 0.0},
                                                       {0.25, 0.25},
                                                       {0.0, 0.5},
                                                       {0.5, 0.25},
                                                       {0.5, 0.5},
                                                       {0.25, 0.75},
                                                       {0.75, 0.75},
                                                       {0.75, 0.25}}};

std::uint32_t opposition_count(const FingerRig& finger) {
    return finger.name == FingerName::thumb ? 3 : 1;
}

double opposition_rad(const FingerRig& finger, std::uint32_t step) {
    const std::uint32_t count = opposition_count(finger);
    const double share = count > 1 ? step / (count - 1.0) : 0.0;
    return finger.lower_opposition_rad +
           share * (finger.upper_opposition_rad - finger.lower_opposition_rad);
}

ChainAngles sample_curl(const SamplePose& sample, const ChainAngles& open_rad,
                        const ChainAngles& closed_rad, std::size_t link_count) {
    ChainAngles angle_rad = {};
    for (std::size_t i = 0; i < link_count; ++i) {
        angle_rad[i] =
            open_rad[i] + (i == 0 ? sample.first : sample.others) * (closed_rad[i] - open_rad[i]);
    }
    return angle_rad;
}

// Returns, per hinge, the largest curl of any sample pose. Bounds the region in which triangles are
// gathered.
ChainAngles max_sample_curl(const HingeChain& chain) {
    constexpr SamplePose k_largest = [] {
        SamplePose largest = {0.0, 0.0};
        for (const SamplePose& sample : k_pose_samples) {
            largest = {std::max(largest.first, sample.first),
                       std::max(largest.others, sample.others)};
        }
        return largest;
    }();
    return sample_curl(k_largest, chain.open_rad, chain.closed_rad, chain.link_count);
}

struct BestSample {
    double penetration_m = std::numeric_limits<double>::infinity();
    std::size_t sample = 0;  // index into k_pose_samples
    std::uint32_t opposition = 0;

    bool has_clearance() const { return penetration_m <= k_finger_penetration_tolerance_m; }
};

// Evaluates the straight pose alone. It is usually clear and needs few triangles.
void evaluate_straight(const HandSurroundings& hand, const HingeChain& chain,
                       std::uint32_t opposition, ChainPatch& patch, BestSample& best) {
    const double straight_m = posed_depth_m(chain, chain.open_rad, hand.meshes, patch);
    if (straight_m < best.penetration_m) {
        best = {straight_m, 0, opposition};
    }
}

// Evaluates the other sample poses, at the opposition of the best pose so far. Stops at the first
// pose with clearance.
void evaluate_samples(const HandSurroundings& hand, const HingeChain& chain, ChainPatch& patch,
                      BestSample& best) {
    patch.gather(
        chain_reach(chain, chain.open_rad, highest(chain.open_rad, max_sample_curl(chain))),
        hand.meshes);
    ChainDepths depths(chain, patch);
    for (std::size_t i = 1; i < k_pose_samples.size() && !best.has_clearance(); ++i) {
        const double depth_m = depths.depth_m(
            sample_curl(k_pose_samples[i], chain.open_rad, chain.closed_rad, chain.link_count),
            best.penetration_m);
        if (depth_m < best.penetration_m) {
            best = {depth_m, i, best.opposition};
        }
    }
}

}  // namespace

FingerClearance find_finger_clearance(const HandSurroundings& hand, const Pose& wrist_bs,
                                      ChainPatch& patch) {
    FingerClearance clearance;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        const auto chain_at = [&](std::uint32_t opposition) {
            return finger_chain(finger, opposition_rad(finger, opposition), wrist_bs);
        };
        BestSample best;
        for (std::uint32_t i = 0; i < opposition_count(finger) && !best.has_clearance(); ++i) {
            evaluate_straight(hand, chain_at(i), i, patch, best);
        }
        if (!best.has_clearance()) {
            evaluate_samples(hand, chain_at(best.opposition), patch, best);
        }
        if (!best.has_clearance()) {
            clearance.finger_samples[f] = static_cast<std::uint8_t>(
                1 + best.sample + k_pose_samples.size() * best.opposition);
        }
        clearance.penetration_m = std::max(clearance.penetration_m, best.penetration_m);
    }
    return clearance;
}

double sample_pose_depth_m(const HandSurroundings& hand, const FingerSamplePoses& finger_samples,
                           const Pose& wrist_bs, ChainPatch& patch) {
    double depth_m = 0.0;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        const auto angles = sample_pose_angles(finger, finger_samples[f]);
        if (angles) {
            const HingeChain chain = finger_chain(finger, angles->opposition_rad, wrist_bs);
            depth_m = std::max(depth_m, posed_depth_m(chain, angles->curl_rad, hand.meshes, patch));
        }
    }
    return depth_m;
}

std::optional<FingerAngles> sample_pose_angles(const FingerRig& finger, std::uint8_t sample) {
    if (sample == 0 || sample > k_pose_samples.size() * opposition_count(finger)) {
        return std::nullopt;
    }
    const std::size_t index = sample - std::size_t{1};
    FingerAngles angles;
    angles.curl_rad = sample_curl(k_pose_samples[index % k_pose_samples.size()], finger.lower_rad,
                                  finger.upper_rad, finger.link_count);
    angles.opposition_rad =
        opposition_rad(finger, static_cast<std::uint32_t>(index / k_pose_samples.size()));
    return angles;
}

}  // namespace handhold
