#include "systems/rigs/body_fingers.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "systems/rigs/body_joint_names.hpp"
#include "systems/rigs/finger_joint_names.hpp"
#include "systems/rigs/hand_skeleton_fit.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_most_hinges = k_max_links;
// Joints of a finger that are closer than this share of the hand's length are in one place.
constexpr double k_same_place = 0.01;

struct NamedJoint {
    std::size_t joint = 0;
    FingerJointGuess name;
    bool is_spare = false;
};

bool is_named(const NamedJoint& joint, HandBone bone) { return joint.name.bone == bone; }

// Finds the joints of one finger.
class FingerFinder {
  public:
    FingerFinder(const SkinnedMesh& figure, std::size_t hand, FingerName finger)
        : figure_(figure), tree_(figure), hand_(hand), finger_(finger) {}

    std::optional<FigureFinger> find(const std::vector<NamedJoint>& named) {
        std::vector<NamedJoint> chain = longest_chain(named);
        const auto tip = std::ranges::find_if(
            chain, [](const NamedJoint& joint) { return is_named(joint, HandBone::tip); });
        std::optional<std::size_t> end;
        if (tip != chain.end()) {
            end = tip->joint;
            chain.erase(tip, chain.end());
        }
        merge_places(chain, end);
        drop_metacarpal(chain);
        if (chain.size() > k_most_hinges) {
            end = chain[k_most_hinges].joint;
            chain.resize(k_most_hinges);
        }
        if (chain.empty() || (chain.size() == 1 && !end)) {
            return std::nullopt;
        }
        FigureFinger found{finger_, {}, end};
        for (std::size_t i = 0; i < chain.size(); ++i) {
            found.hinges.push_back({chain[i].joint, bone_of(i, chain.size())});
        }
        return found;
    }

  private:
    // The joints of the longest path from the hand outwards. Joints beside each other, as in
    // skeletons without a hierarchy, are ordered by what their names say.
    std::vector<NamedJoint> longest_chain(const std::vector<NamedJoint>& named) const {
        std::vector<NamedJoint> best;
        for (const NamedJoint& last : named) {
            std::vector<NamedJoint> chain;
            for (const NamedJoint& joint : named) {
                if (joint.joint == last.joint || is_below(figure_, last.joint, joint.joint)) {
                    chain.push_back(joint);
                }
            }
            std::ranges::stable_sort(
                chain, {}, [&](const NamedJoint& joint) { return tree_.depth(joint.joint); });
            if (std::pair(chain.size(), place_in_name(last)) >
                std::pair(best.size(), best.empty() ? 0 : place_in_name(best.back()))) {
                best = std::move(chain);
            }
        }
        if (best.size() == 1 && named.size() > 1) {
            best = named;
            std::ranges::stable_sort(best, {}, &FingerFinder::place_in_name);
        }
        return best;
    }
    // Larger for joints farther out.
    static int place_in_name(const NamedJoint& joint) {
        constexpr int k_beyond_numbers = 100;
        if (is_named(joint, HandBone::tip)) {
            return k_beyond_numbers;
        }
        return joint.name.number.value_or(0) +
               (joint.name.bone ? static_cast<int>(*joint.name.bone) : 0);
    }

    // Of joints in one place, keeps the last one.
    void merge_places(std::vector<NamedJoint>& chain, std::optional<std::size_t>& tip) const {
        if (chain.empty()) {
            return;
        }
        const std::size_t outermost = tip.value_or(chain.back().joint);
        const double least =
            k_same_place * (place_of(figure_, outermost) - place_of(figure_, hand_)).norm();
        const auto is_near = [&](std::size_t a, std::size_t b) {
            return (place_of(figure_, a) - place_of(figure_, b)).norm() <= least;
        };
        if (tip && is_near(chain.back().joint, *tip)) {
            tip.reset();
        }
        for (std::size_t i = chain.size() - 1; i-- > 0;) {
            if (is_near(chain[i].joint, chain[i + 1].joint)) {
                chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
    }

    // Removes a joint inside the palm.
    void drop_metacarpal(std::vector<NamedJoint>& chain) const {
        const bool is_thumb = finger_ == FingerName::thumb;
        if (!is_thumb && !chain.empty() && is_named(chain.front(), HandBone::metacarpal)) {
            chain.erase(chain.begin());
        }
        if (chain.size() <= k_most_hinges) {
            return;
        }
        const auto& first = chain[0].name.number;
        const auto& second = chain[1].name.number;
        const bool is_counted = first || second;
        if (is_counted ? first.value_or(0) == 0 : !is_thumb && is_in_palm(chain)) {
            chain.erase(chain.begin());
        }
    }
    // True if the first joint is much nearer to the wrist than the second one.
    bool is_in_palm(const std::vector<NamedJoint>& chain) const {
        const auto from_wrist = [&](const NamedJoint& joint) {
            return (place_of(figure_, joint.joint) - place_of(figure_, hand_)).norm();
        };
        return from_wrist(chain[0]) < 0.5 * from_wrist(chain[1]);
    }

    HandBone bone_of(std::size_t hinge, std::size_t hinges) const {
        constexpr std::array k_finger = {HandBone::proximal, HandBone::intermediate,
                                         HandBone::distal};
        constexpr std::array k_thumb = {HandBone::metacarpal, HandBone::proximal, HandBone::distal};
        return finger_ == FingerName::thumb ? k_thumb[k_most_hinges - hinges + hinge]
                                            : k_finger[hinge];
    }

    const SkinnedMesh& figure_;
    JointTree tree_;
    std::size_t hand_;
    FingerName finger_;
};

// Joints of a finger by the map, in the order of HandBone.
std::optional<FigureFinger> mapped_finger(const SideFingers& mapped, FingerName finger) {
    FigureFinger found{finger, {}, std::nullopt};
    for (std::size_t bone = 0; bone < k_hand_bone_count; ++bone) {
        const auto& joint = mapped[static_cast<std::size_t>(finger)][bone];
        const auto name = static_cast<HandBone>(bone);
        if (!joint || (name == HandBone::metacarpal && finger != FingerName::thumb)) {
            continue;
        }
        if (name == HandBone::tip) {
            found.tip = joint;
        } else {
            found.hinges.push_back({*joint, name});
        }
    }
    const bool is_there =
        found.hinges.size() > 1 || (found.hinges.size() == 1 && found.tip.has_value());
    return is_there ? std::optional(found) : std::nullopt;
}

}  // namespace

std::vector<FigureFinger> find_figure_fingers(const SkinnedMesh& figure, const BodyBones& bones,
                                              HandSide side) {
    const std::size_t hand = *bones.limb(side, BodyBone::hand);
    const std::size_t forearm = *bones.limb(side, BodyBone::forearm);
    const std::string prefix = shared_name_prefix(figure);
    std::array<std::vector<NamedJoint>, k_finger_count> named;
    for (std::size_t i = 0; i < figure.joints.size(); ++i) {
        const std::string_view name = bare_name(figure.joints[i].name, prefix);
        const auto guess = i != hand && is_below(figure, i, forearm) ? parse_finger_joint_name(name)
                                                                     : std::nullopt;
        if (guess) {
            named[static_cast<std::size_t>(guess->finger)].push_back(
                {i, *guess, is_spare_name(name)});
        }
    }
    std::vector<FigureFinger> fingers;
    for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
        std::vector<NamedJoint>& joints = named[finger];
        const auto is_deforming = [](const NamedJoint& joint) { return !joint.is_spare; };
        if (std::ranges::any_of(joints, is_deforming)) {
            std::erase_if(joints, [](const NamedJoint& joint) { return joint.is_spare; });
        }
        const auto name = static_cast<FingerName>(finger);
        auto found = mapped_finger(bones.fingers[index_of(side)], name);
        if (!found) {
            found = FingerFinder(figure, hand, name).find(joints);
        }
        if (found) {
            fingers.push_back(std::move(*found));
        }
    }
    return fingers;
}

std::optional<Quat> figure_hand_axes(const SkinnedMesh& figure, std::size_t hand,
                                     const std::vector<FigureFinger>& fingers, HandSide side) {
    std::vector<Knuckle> knuckles;
    double reach_m = 0.0;
    for (const FigureFinger& finger : fingers) {
        const Vec3 from_wrist =
            place_of(figure, finger.hinges.front().joint) - place_of(figure, hand);
        knuckles.push_back({finger.name, from_wrist});
        reach_m = std::max(reach_m, from_wrist.norm());
    }
    if (!(reach_m > 0.0)) {
        return std::nullopt;
    }
    // Figures have any size, hands in find_hand_axes that of people.
    constexpr double k_usual_reach_m = 0.1;
    for (Knuckle& knuckle : knuckles) {
        knuckle.place *= k_usual_reach_m / reach_m;
    }
    return find_hand_axes(Vec3::Zero(), knuckles, side);
}

std::vector<BodyRig::Carrier> finger_carriers(const SkinnedMesh& figure, const FigureFinger& finger,
                                              const Pose& hand_ms, HandSide side, std::size_t first,
                                              std::size_t hand) {
    std::vector<Vec3> points_ms;
    points_ms.reserve(finger.hinges.size() + 1);
    for (const FigureHinge& hinge : finger.hinges) {
        points_ms.push_back(place_of(figure, hinge.joint));
    }
    if (finger.tip) {
        points_ms.push_back(place_of(figure, *finger.tip));
    } else {  // the last bone continues the one before
        points_ms.push_back(2.0 * points_ms.back() - points_ms[points_ms.size() - 2]);
    }
    std::vector<Vec3> points_hs;
    points_hs.reserve(points_ms.size());
    for (const Vec3& point : points_ms) {
        points_hs.push_back(inverse_transform_point(hand_ms, point));
    }
    const Vec3 hinge_ms = hand_ms.rotation * find_hinge_axis(finger.name, points_hs, side);
    std::vector<BodyRig::Carrier> carriers;
    carriers.reserve(finger.hinges.size());
    for (std::size_t i = 0; i < finger.hinges.size(); ++i) {
        const HandBone next =
            i + 1 < finger.hinges.size() ? finger.hinges[i + 1].bone : HandBone::tip;
        BodyRig::Carrier bone;
        bone.bone = BodyBone::finger;
        bone.side = side;
        bone.rest_ms = {points_ms[i], hinge_rotation(points_ms[i + 1] - points_ms[i], hinge_ms)};
        bone.from_joint = hand_joint_index(finger.name, finger.hinges[i].bone);
        bone.to_joint = hand_joint_index(finger.name, next);
        bone.above = i == 0 ? hand : first + i - 1;
        carriers.push_back(bone);
    }
    return carriers;
}

}  // namespace handhold
