#include "systems/rigs/finger_curls.hpp"

#include <algorithm>
#include <span>

#include "components/hand_rig.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold {
namespace {

constexpr double k_shortest_bone_m = 1e-4;  // the joints of shorter bones coincide

std::optional<Vec3> bone(const std::optional<Vec3>& from, const std::optional<Vec3>& to) {
    if (!from || !to) {
        return std::nullopt;
    }
    const Vec3 along = *to - *from;
    return is_finite(along) && along.norm() > k_shortest_bone_m ? std::optional(along)
                                                                : std::nullopt;
}

// Sum of a finger's bends; k_unknown_curl if a joint is absent or not finite. `joints`: the
// finger's joints from the one before the first bend to the tip.
double bend_rad(std::span<const std::optional<Vec3>> joints) {
    double sum_rad = 0.0;
    for (std::size_t i = 0; i + 2 < joints.size(); ++i) {
        const std::optional<Vec3> before = bone(joints[i], joints[i + 1]);
        const std::optional<Vec3> after = bone(joints[i + 1], joints[i + 2]);
        if (!before || !after) {
            return k_unknown_curl;
        }
        const Vec3 across = before->cross(*after);
        sum_rad += arc_tangent2(across.norm(), before->dot(*after));
    }
    return sum_rad;
}

double fist_bend_rad(FingerName name) {
    FingerRig finger;
    finger.name = name;
    set_hand_limits(HandSide::right, finger);
    double sum_rad = 0.0;
    for (std::size_t link = name == FingerName::thumb ? 1 : 0; link < finger.link_count; ++link) {
        sum_rad += finger.fist.curl_rad[link];
    }
    return sum_rad;
}

}  // namespace

FingerCurls finger_curls(const TrackedJoints& joints) {
    constexpr std::size_t k_thumb_joints = 4;
    constexpr std::size_t k_finger_joints = 5;
    FingerCurls curls = k_unknown_curls;
    std::size_t first = 2;  // palm and wrist come first
    for (std::size_t f = 0; f < k_finger_count; ++f) {
        const auto name = static_cast<FingerName>(f);
        const std::size_t count = name == FingerName::thumb ? k_thumb_joints : k_finger_joints;
        const double bend = bend_rad(std::span(joints).subspan(first, count));
        if (bend >= 0.0) {
            curls[f] = std::min(1.0, bend / fist_bend_rad(name));
        }
        first += count;
    }
    return curls;
}

}  // namespace handhold
