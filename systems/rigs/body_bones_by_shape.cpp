// Finds bones from the joints' hierarchy and positions, for figures whose joint names do not
// determine them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/rigs/body_bones.hpp"

namespace handhold {
namespace {

using JointPath = std::vector<std::size_t>;  // joints from the root's side down the hierarchy

struct LimbKind {
    BodyBone upper, lower, end;
};
constexpr LimbKind k_arm_limb = {BodyBone::upper_arm, BodyBone::forearm, BodyBone::hand};
constexpr LimbKind k_leg_limb = {BodyBone::thigh, BodyBone::shin, BodyBone::foot};

class ShapeFinder {
  public:
    ShapeFinder(const SkinnedMesh& figure, BodyBones& bones)
        : figure_(figure), bones_(bones), tree_(figure) {}

    void fill() {
        if (figure_.joints.empty() || !find_axes()) {
            return;
        }
        const std::array<JointPath, 2> arms = limb_paths(k_arm_limb);
        const std::array<JointPath, 2> legs = limb_paths(k_leg_limb);
        for (std::size_t at = 0; at < 2; ++at) {
            const HandSide side = at == 0 ? HandSide::left : HandSide::right;
            fill_limb(k_arm_limb, side, arms[at]);
            fill_limb(k_leg_limb, side, legs[at]);
        }
        fill_head();
    }

  private:
    const Vec3& place(std::size_t joint) const { return place_of(figure_, joint); }
    double aside(std::size_t joint) const { return (place(joint) - middle_).dot(left_); }
    double height(std::size_t joint) const { return place(joint).y(); }
    double distance(std::size_t a, std::size_t b) const { return (place(a) - place(b)).norm(); }
    bool is_leaf(std::size_t joint) const { return tree_.children(joint).empty(); }

    // Finds the direction to the figure's left, the middle of its joints, and its height. Left
    // follows from known limbs. Without any, it is along the horizontal direction in which the
    // joints spread most; the direction of the feet decides its sign.
    bool find_axes() {
        double low = std::numeric_limits<double>::max();
        double high = -low;
        Vec3 sum = Vec3::Zero();
        for (const SkinJoint& joint : figure_.joints) {
            low = std::min(low, joint.bind_ms.position.y());
            high = std::max(high, joint.bind_ms.position.y());
            sum += joint.bind_ms.position;
        }
        height_m_ = high - low;
        lowest_m_ = low;
        middle_ = sum / static_cast<double>(figure_.joints.size());
        if (!(height_m_ > 0.0) || !std::isfinite(height_m_)) {
            return false;
        }
        left_ = left_from_bones();
        if (left_ != Vec3::Zero()) {
            return true;
        }
        const Vec3 widest = widest_direction();
        if (widest == Vec3::Zero()) {
            return false;
        }
        left_ = widest;
        const Vec3 ahead = toes_direction();
        left_ = Vec3::UnitY().cross(ahead).dot(widest) < 0.0 ? Vec3(-widest) : widest;
        return true;
    }
    Vec3 left_from_bones() const {
        for (const BodyBone bone : {BodyBone::hand, BodyBone::forearm, BodyBone::upper_arm,
                                    BodyBone::thigh, BodyBone::shin, BodyBone::foot}) {
            const auto& left = bones_.limb(HandSide::left, bone);
            const auto& right = bones_.limb(HandSide::right, bone);
            if (left && right) {
                Vec3 across = place(*left) - place(*right);
                across.y() = 0.0;
                if (across.norm() > 1e-3 * height_m_) {
                    return across.normalized();
                }
            }
        }
        return Vec3::Zero();
    }
    // Principal axis of the joints' horizontal covariance [xx xz; xz zz].
    Vec3 widest_direction() const {
        double xx = 0.0;
        double xz = 0.0;
        double zz = 0.0;
        for (const SkinJoint& joint : figure_.joints) {
            const Vec3 off = joint.bind_ms.position - middle_;
            xx += off.x() * off.x();
            xz += off.x() * off.z();
            zz += off.z() * off.z();
        }
        if (!(xx + zz > 0.0)) {
            return Vec3::Zero();
        }
        const double angle = 0.5 * arc_tangent2(2.0 * xz, xx - zz);
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(angle, sine, cosine);
        return {cosine, 0.0, sine};
    }
    // Horizontal direction in which the feet point: from the foot's joint to the mean of the skin
    // that it carries. If that is unclear, +Z, in which glTF assets face.
    Vec3 toes_direction() const {
        const std::array<JointPath, 2> legs = limb_paths(k_leg_limb);
        Vec3 ahead = Vec3::Zero();
        for (const JointPath& leg : legs) {
            if (leg.empty()) {
                continue;
            }
            const std::size_t foot = foot_on(leg);
            Vec3 sum = Vec3::Zero();
            double weight = 0.0;
            for (std::size_t i = 0; i < figure_.positions.size(); ++i) {
                const std::size_t joint = heaviest_joint(figure_.weights[i]);
                if (joint == foot || is_below(figure_, joint, foot)) {
                    sum += figure_.positions[i] - place(foot);
                    weight += 1.0;
                }
            }
            ahead += weight > 0.0 ? Vec3(sum / weight) : Vec3(place(leg.back()) - place(foot));
        }
        ahead -= left_ * left_.dot(ahead);
        ahead.y() = 0.0;
        return ahead.norm() > 5e-3 * height_m_ ? ahead : Vec3(Vec3::UnitZ());
    }

    // Paths of both limbs, by HandSide: from the first joint below their common ancestor to their
    // last joint. Empty if they are not found.
    std::array<JointPath, 2> limb_paths(const LimbKind& kind) const {
        std::array<std::optional<std::size_t>, 2> ends;
        for (std::size_t at = 0; at < 2; ++at) {
            ends[at] = end_of(kind, at == 0 ? HandSide::left : HandSide::right);
        }
        if (!ends[0] || !ends[1]) {
            return {};
        }
        std::array<JointPath, 2> paths = {tree_.path_to(*ends[0]), tree_.path_to(*ends[1])};
        std::size_t shared = 0;
        while (shared < paths[0].size() && shared < paths[1].size() &&
               paths[0][shared] == paths[1][shared]) {
            ++shared;
        }
        for (JointPath& path : paths) {
            path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(shared));
            if (path.size() < 3) {
                return {};
            }
        }
        return paths;
    }
    // The joint without children that lies farthest out (arms) or lowest (legs) on that side. If
    // joints of the limb are known, only joints below them count.
    std::optional<std::size_t> end_of(const LimbKind& kind, HandSide side) const {
        // Joints closer to the middle than this share of the height belong to no side.
        constexpr double k_middle_share = 0.01;
        std::optional<std::size_t> known;
        for (const BodyBone bone : {kind.end, kind.lower, kind.upper}) {
            if (!known && bones_.limb(side, bone)) {
                known = bones_.limb(side, bone);
            }
        }
        const double to_side = side == HandSide::left ? 1.0 : -1.0;
        std::optional<std::size_t> best;
        double most = 0.0;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            if (!is_leaf(i) || to_side * aside(i) < k_middle_share * height_m_ ||
                (known && i != *known && !is_below(figure_, i, *known))) {
                continue;
            }
            // For legs, prefers the joint deepest in the hierarchy among those at about the same
            // height.
            const double out =
                kind.end == BodyBone::hand
                    ? to_side * aside(i)
                    : -height(i) + 1e-3 * height_m_ * static_cast<double>(tree_.depth(i));
            if (!best || out > most) {
                best = i;
                most = out;
            }
        }
        return best ? best : known;
    }

    // The first joint of a leg's path that is near the ground.
    std::size_t foot_on(const JointPath& path) const {
        constexpr double k_near_ground = 0.2;  // share of the hip's height
        const double hip_m = height(path.front()) - lowest_m_;
        for (const std::size_t joint : path) {
            if (height(joint) - lowest_m_ < k_near_ground * hip_m) {
                return joint;
            }
        }
        return path.back();
    }
    // The first joint of an arm's path that has at least two fingers: children with children.
    std::optional<std::size_t> palm_on(const JointPath& path) const {
        for (const std::size_t joint : path) {
            const auto& children = tree_.children(joint);
            const auto fingers = std::count_if(children.begin(), children.end(),
                                               [&](std::size_t c) { return !is_leaf(c); });
            if (fingers >= 2) {
                return joint;
            }
        }
        return std::nullopt;
    }

    // Chooses the limb's three joints on the path so that limb_cost is least. Known joints are
    // kept.
    void fill_limb(const LimbKind& kind, HandSide side, const JointPath& path) {
        const auto known = [&](BodyBone bone) { return bones_.limb(side, bone); };
        if (path.empty() || (known(kind.upper) && known(kind.lower) && known(kind.end))) {
            return;
        }
        std::optional<std::size_t> end = known(kind.end);
        if (!end) {
            end = kind.end == BodyBone::foot ? foot_on(path) : palm_on(path);
        }
        // The longest path without fingers on which the hand can be recognised: clavicle, upper
        // arm, forearm, hand and one more joint.
        constexpr std::size_t k_longest = 5;
        if (!end && !known(kind.upper) && !known(kind.lower) && path.size() > k_longest) {
            return;
        }
        std::array<std::size_t, 3> best{};
        double least = std::numeric_limits<double>::max();
        for (std::size_t k = 2; k < path.size(); ++k) {
            for (std::size_t j = 1; j < k; ++j) {
                for (std::size_t i = 0; i < j; ++i) {
                    const std::array<std::size_t, 3> limb = {path[i], path[j], path[k]};
                    const auto fits = [&](BodyBone bone, std::size_t joint) {
                        return !known(bone) || *known(bone) == joint;
                    };
                    if (!fits(kind.upper, limb[0]) || !fits(kind.lower, limb[1]) ||
                        (end && *end != limb[2])) {
                        continue;
                    }
                    const double cost = limb_cost(limb, path);
                    if (cost < least) {
                        least = cost;
                        best = limb;
                    }
                }
            }
        }
        if (least == std::numeric_limits<double>::max()) {
            return;
        }
        bones_.at({kind.upper, side}) = best[0];
        bones_.at({kind.lower, side}) = best[1];
        bones_.at({kind.end, side}) = best[2];
        if (kind.end == BodyBone::hand && !known(BodyBone::clavicle) && best[0] != path.front()) {
            bones_.at({BodyBone::clavicle, side}) = path.front();
        }
    }
    // Cost of taking these joints as the limb. Low if upper and lower part have equal lengths, and
    // little of the path lies before the limb or beyond its end.
    double limb_cost(const std::array<std::size_t, 3>& limb, const JointPath& path) const {
        // Usual length of the path beyond the limb's end / limb's length.
        constexpr double k_usual_rest = 0.3;
        const double upper_m = distance(limb[0], limb[1]);
        const double lower_m = distance(limb[1], limb[2]);
        const double limb_m = upper_m + lower_m;
        if (!(upper_m > 1e-3 * height_m_) || !(lower_m > 1e-3 * height_m_)) {
            return std::numeric_limits<double>::max();
        }
        const double rest = distance(limb[2], path.back()) / limb_m;
        const double before = distance(path.front(), limb[0]) / limb_m;
        return std::abs(natural_logarithm(upper_m / lower_m)) + std::max(0.0, rest - k_usual_rest) +
               0.5 * before;
    }

    // Finds head and neck on the path that leads up from the common ancestor of both arms.
    void fill_head() {
        if (bones_.of_middle(BodyBone::head) && bones_.of_middle(BodyBone::neck)) {
            return;
        }
        const JointPath path = head_path();
        if (path.empty()) {
            return;
        }
        auto& head = bones_.at({BodyBone::head, HandSide::left});
        if (!head) {
            head = head_on(path);
        }
        auto& neck = bones_.at({BodyBone::neck, HandSide::left});
        if (!neck && *head != path.front() && is_below(figure_, *head, path.front())) {
            neck = path.front();
        }
    }
    // Joints from the first one below the arms' common ancestor to the highest joint without
    // children, arms excluded.
    JointPath head_path() const {
        const auto& left = bones_.limb(HandSide::left, BodyBone::upper_arm);
        const auto& right = bones_.limb(HandSide::right, BodyBone::upper_arm);
        if (!left || !right) {
            return {};
        }
        const JointPath to_left = tree_.path_to(*left);
        const JointPath to_right = tree_.path_to(*right);
        std::size_t shared = 0;
        while (shared < std::min(to_left.size(), to_right.size()) &&
               to_left[shared] == to_right[shared]) {
            ++shared;
        }
        if (shared == 0 || shared == to_left.size() || shared == to_right.size()) {
            return {};
        }
        const std::size_t chest = to_left[shared - 1];
        const auto& known = bones_.of_middle(BodyBone::head);
        std::optional<std::size_t> top;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const bool is_candidate = is_leaf(i) && is_below(figure_, i, chest) && i != *left &&
                                      i != *right && !is_below(figure_, i, to_left[shared]) &&
                                      !is_below(figure_, i, to_right[shared]) &&
                                      height(i) > height(chest) &&
                                      (!known || i == *known || is_below(figure_, i, *known));
            if (is_candidate && (!top || height(i) > height(*top))) {
                top = i;
            }
        }
        if (!top) {
            return {};
        }
        JointPath path = tree_.path_to(*top);
        path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(shared));
        return path;
    }
    // Goes up the path while the next joint, with all joints below it, carries enough skin: more
    // than its siblings together, and more than half as much as the current joint alone. Without
    // skin: the last but one joint, since the last one only marks the end.
    std::size_t head_on(const JointPath& path) const {
        if (!(tree_.skin_below(path.front()) > 0.0)) {
            return path.size() > 2 ? path[path.size() - 2] : path.back();
        }
        std::size_t at = 0;
        while (at + 1 < path.size()) {
            const double next = tree_.skin_below(path[at + 1]);
            const double own = tree_.skin(path[at]);
            const double siblings = tree_.skin_below(path[at]) - own - next;
            if (!(next > siblings) || !(next > 0.5 * own)) {
                break;
            }
            ++at;
        }
        return path[at];
    }

    const SkinnedMesh& figure_;
    BodyBones& bones_;
    JointTree tree_;
    Vec3 left_ = Vec3::Zero();
    Vec3 middle_ = Vec3::Zero();
    double height_m_ = 0.0;
    double lowest_m_ = 0.0;
};

}  // namespace

void fill_bones_by_shape(const SkinnedMesh& figure, BodyBones& bones) {
    ShapeFinder(figure, bones).fill();
}

}  // namespace handhold
