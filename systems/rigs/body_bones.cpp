#include "systems/rigs/body_bones.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace handhold {
namespace {

constexpr std::array k_sides = {HandSide::left, HandSide::right};

// Finds bones by the map, by names and by shape.
class BoneFinder {
  public:
    BoneFinder(const SkinnedMesh& figure, const BodyBones& mapped, const char* names)
        : figure_(figure),
          mapped_(mapped),
          names_(names),
          tree_(figure),
          prefix_(shared_name_prefix(figure)),
          bones_(mapped) {
        mark_used(mapped, is_mapped_);
    }

    Result<BodyBones> find() {
        find_named();
        for (const HandSide side : k_sides) {
            use_last_joints(side);
        }
        find_second_meanings();
        fill_bones_by_shape(figure_, bones_);
        std::string wrong = what_is_wrong(bones_);
        if (wrong.empty()) {
            return bones_;
        }
        bones_ = mapped_;
        fill_bones_by_shape(figure_, bones_);
        if (what_is_wrong(bones_).empty()) {
            return bones_;
        }
        return FileError{figure_.file, "/nodes", wrong + "; " + names_ + " can name the joints"};
    }

  private:
    void mark_used(const BodyBones& bones, std::vector<bool>& is_used) const {
        is_used.assign(figure_.joints.size(), false);
        const auto mark = [&](const auto& joints) {
            for (const auto& joint : joints) {
                if (joint) {
                    is_used[*joint] = true;
                }
            }
        };
        mark(bones.middle);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            mark(bones.sides[side]);
            std::ranges::for_each(bones.fingers[side], mark);
        }
    }
    bool is_mapped(const BodyJointName& name) const {
        return (is_limb(name.bone) ? mapped_.limb(name.side, name.bone)
                                   : mapped_.of_middle(name.bone))
            .has_value();
    }

    // Returns the bone that a joint's name indicates; none for twist and helper joints and for
    // joints that are in the map.
    std::optional<BodyNameGuess> guess_of(std::size_t joint) const {
        if (is_mapped_[joint]) {
            return std::nullopt;
        }
        auto guess = parse_body_joint_name(bare_name(figure_.joints[joint].name, prefix_));
        return guess && !guess->is_part ? guess : std::nullopt;
    }

    // Ranks joints whose names indicate the same bone; lower is better. In this order: clear names,
    // joints that deform the skin, joints with joints below them, joints near the root, joints with
    // many joints below them.
    using Rank = std::tuple<int, bool, bool, std::size_t, std::ptrdiff_t>;
    Rank rank_of(std::size_t joint, int doubt) const {
        return {doubt, is_spare_name(bare_name(figure_.joints[joint].name, prefix_)),
                tree_.size(joint) == 0, tree_.depth(joint),
                -static_cast<std::ptrdiff_t>(tree_.size(joint))};
    }

    void find_named() {
        std::map<std::optional<std::size_t>*, Rank> best;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = guess_of(i);
            if (!guess || is_mapped(guess->name)) {
                continue;
            }
            std::optional<std::size_t>& bone = bones_.at(guess->name);
            const Rank rank = rank_of(i, guess->doubt);
            if (!bone || rank < best[&bone]) {
                bone = i;
                best[&bone] = rank;
            }
        }
    }

    // Robots have one joint per axis of a shoulder or hip. Their limb begins at the last of these
    // joints.
    void use_last_joints(HandSide side) {
        auto& upper = bones_.at({BodyBone::upper_arm, side});
        const auto& forearm = bones_.limb(side, BodyBone::forearm);
        if (!upper && forearm) {
            upper = last_above({BodyBone::clavicle, side}, *forearm);
        }
        // Meshes may be named "hand" too. The hand's joint is the one below the forearm.
        if (forearm && !is_mapped({BodyBone::hand, side})) {
            if (const auto hand = first_below({BodyBone::hand, side}, *forearm)) {
                bones_.at({BodyBone::hand, side}) = hand;
            }
        }
        const auto& shin = bones_.limb(side, BodyBone::shin);
        auto& thigh = bones_.at({BodyBone::thigh, side});
        if (shin && !is_mapped({BodyBone::thigh, side})) {
            const auto last = last_above({BodyBone::thigh, side}, *shin);
            if (last && !(thigh && is_on_bone(*last, *thigh, *shin))) {
                thigh = last;
            }
        }
        auto& clavicle = bones_.at({BodyBone::clavicle, side});
        if (clavicle && upper && forearm && are_in_one_place(*clavicle, *upper, *forearm)) {
            clavicle.reset();
        }
    }
    // True if `joint` splits the bone from `upper` to `lower`: it lies on the line between them,
    // well away from `upper`.
    bool is_on_bone(std::size_t joint, std::size_t upper, std::size_t lower) const {
        constexpr double k_inside = 0.1;
        constexpr double k_aside = 0.1;
        const Vec3 bone = place_of(figure_, lower) - place_of(figure_, upper);
        const Vec3 at = place_of(figure_, joint) - place_of(figure_, upper);
        const double along = at.dot(bone) / bone.squaredNorm();
        return along > k_inside && (at - along * bone).norm() < k_aside * at.norm();
    }
    // True if `joint` and `upper` coincide: their distance is at most 0.3 % of the upper arm's
    // length.
    bool are_in_one_place(std::size_t joint, std::size_t upper, std::size_t forearm) const {
        constexpr double k_share = 0.003;
        const Vec3& shoulder = place_of(figure_, upper);
        const double arm_m = (place_of(figure_, forearm) - shoulder).norm();
        return (place_of(figure_, joint) - shoulder).norm() <= k_share * arm_m;
    }

    // Returns the nearest joint above `joint` whose name indicates the bone `name`.
    std::optional<std::size_t> last_above(const BodyJointName& name, std::size_t joint) const {
        std::optional<std::size_t> last;
        const std::vector<std::size_t> path = tree_.path_to(joint);
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const auto guess = guess_of(path[i]);
            if (guess && guess->name == name) {
                last = path[i];
            }
        }
        return last;
    }

    // Returns the best joint below `joint` whose name indicates the bone `name`.
    std::optional<std::size_t> first_below(const BodyJointName& name, std::size_t joint) const {
        std::optional<std::size_t> first;
        Rank best;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = guess_of(i);
            if (!guess || guess->name != name || !is_below(figure_, i, joint)) {
                continue;
            }
            // Hands may have no joints below them, so this is no disadvantage here. The joint
            // nearest to the root is preferred.
            const Rank rank = {guess->doubt, false, false, tree_.depth(i),
                               -static_cast<std::ptrdiff_t>(tree_.size(i))};
            if (!first || rank < best) {
                first = i;
                best = rank;
            }
        }
        return first;
    }

    // Assigns joints by the second meaning of their name (BodyNameGuess::other): "Shoulder" is the
    // upper arm if there is a scapula too, "Leg" the thigh if there is a knee.
    void find_second_meanings() {
        std::vector<bool> is_used;
        mark_used(bones_, is_used);
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = guess_of(i);
            if (guess && guess->other != guess->name && !is_used[i] && !bones_.at(guess->other)) {
                bones_.at(guess->other) = i;
            }
        }
    }

    std::string what_is_wrong(BodyBones& bones) const {
        std::string missing;
        const auto need = [&](const BodyJointName& name) {
            if (!bones.at(name)) {
                missing += (missing.empty() ? "" : ", ") + body_joint_text(name);
            }
        };
        need({BodyBone::head, HandSide::left});
        for (const HandSide side : k_sides) {
            need({BodyBone::upper_arm, side});
            need({BodyBone::forearm, side});
            need({BodyBone::hand, side});
        }
        const bool has_thighs = bones.limb(HandSide::left, BodyBone::thigh) &&
                                bones.limb(HandSide::right, BodyBone::thigh);
        if (!has_thighs && !bones.of_middle(BodyBone::trunk)) {
            missing += std::string(missing.empty() ? "" : ", ") + "pelvis (or left_thigh and " +
                       "right_thigh)";
        }
        // If one leg has the bone, the other leg must have it too.
        for (const BodyBone bone : {BodyBone::thigh, BodyBone::shin}) {
            const bool is_left = bones.limb(HandSide::left, bone).has_value();
            if (is_left != bones.limb(HandSide::right, bone).has_value()) {
                need({bone, is_left ? HandSide::right : HandSide::left});
            }
        }
        if (!missing.empty()) {
            return "expected joints of a body, found none for " + missing;
        }
        const std::string shared = find_shared_joint(bones);
        return shared.empty() ? find_implausible_bone(figure_, bones).value_or("") : shared;
    }
    // Describes a joint that was found for two bones; empty if there is none.
    std::string find_shared_joint(BodyBones& bones) const {
        std::map<std::size_t, std::string> users;
        for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
            for (const HandSide side : k_sides) {
                const BodyJointName name{static_cast<BodyBone>(bone), side};
                const auto joint = bones.at(name);
                if (!joint || (!is_limb(name.bone) && side == HandSide::right)) {
                    continue;
                }
                const auto [user, is_new] = users.emplace(*joint, body_joint_text(name));
                if (!is_new) {
                    return "expected a joint for each bone, found \"" +
                           figure_.joints[*joint].name + "\" for " + user->second + " and " +
                           body_joint_text(name);
                }
            }
        }
        return "";
    }

    const SkinnedMesh& figure_;
    const BodyBones& mapped_;
    const char* const names_;
    JointTree tree_;
    std::string prefix_;
    BodyBones bones_;
    std::vector<bool> is_mapped_;  // indexed by joint
};

}  // namespace

std::string shared_name_prefix(const SkinnedMesh& figure) {
    constexpr std::size_t k_words = 3;
    constexpr std::size_t k_fewest = 8;  // joints
    std::string prefix;
    for (std::size_t word = 0; word < k_words; ++word) {
        std::map<std::string_view, std::size_t> counts;
        for (const SkinJoint& joint : figure.joints) {
            const std::string_view name = joint.name;
            if (!name.starts_with(prefix)) {
                continue;
            }
            const std::size_t end = name.find_first_of("_:|-. ", prefix.size() + 1);
            if (end != std::string_view::npos && end + 1 < name.size()) {
                ++counts[name.substr(0, end + 1)];
            }
        }
        const auto most =
            std::max_element(counts.begin(), counts.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        // The first word of a naming convention, such as Rigify's "DEF-", may be found too. It
        // names no bone either.
        if (most == counts.end() || most->second < k_fewest ||
            10 * most->second < 6 * figure.joints.size()) {
            break;
        }
        prefix = most->first;
    }
    return prefix;
}

bool is_below(const SkinnedMesh& figure, std::size_t joint, std::size_t above) {
    std::int32_t at = figure.joints[joint].parent;
    while (at >= 0 && static_cast<std::size_t>(at) != above) {
        at = figure.joints[static_cast<std::size_t>(at)].parent;
    }
    return at >= 0;
}

JointTree::JointTree(const SkinnedMesh& figure)
    : figure_(&figure),
      children_(figure.joints.size()),
      depth_(figure.joints.size(), 0),
      size_(figure.joints.size(), 0),
      skin_(figure.joints.size(), 0.0),
      skin_below_(figure.joints.size(), 0.0) {
    for (const SkinWeights& weights : figure.weights) {
        for (std::size_t k = 0; k < weights.joint.size(); ++k) {
            skin_[weights.joint[k]] += static_cast<double>(weights.weight[k]);
        }
    }
    for (std::size_t i = 0; i < figure.joints.size(); ++i) {
        skin_below_[i] += skin_[i];
        std::int32_t at = figure.joints[i].parent;
        if (at >= 0) {
            children_[static_cast<std::size_t>(at)].push_back(i);
        }
        for (; at >= 0; at = figure.joints[static_cast<std::size_t>(at)].parent) {
            ++depth_[i];
            ++size_[static_cast<std::size_t>(at)];
            skin_below_[static_cast<std::size_t>(at)] += skin_[i];
        }
    }
}

std::vector<std::size_t> JointTree::path_to(std::size_t joint) const {
    std::vector<std::size_t> path;
    for (auto at = static_cast<std::int32_t>(joint); at >= 0;
         at = figure_->joints[static_cast<std::size_t>(at)].parent) {
        path.push_back(static_cast<std::size_t>(at));
    }
    std::reverse(path.begin(), path.end());
    return path;
}

Result<BodyBones> find_mapped_bones(const SkinnedMesh& figure, const BodyMap& map) {
    BodyBones bones;
    std::optional<FileError> error;
    const auto look_up = [&](const std::string& key, std::optional<std::size_t>& bone) {
        const auto entry = map.find(key);
        if (entry == map.end() || error) {
            return;
        }
        const auto joint = std::ranges::find(figure.joints, entry->second, &SkinJoint::name);
        if (joint == figure.joints.end()) {
            error = FileError{figure.file, "/nodes",
                              "expected a joint \"" + entry->second + "\" for " + key};
            return;
        }
        bone = static_cast<std::size_t>(joint - figure.joints.begin());
    };
    for (const HandSide side : k_sides) {
        for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
            const BodyJointName name{static_cast<BodyBone>(bone), side};
            look_up(body_joint_text(name), bones.at(name));
        }
        for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
            for (std::size_t bone = 0; bone < k_hand_bone_count; ++bone) {
                look_up(finger_joint_text(side, static_cast<FingerName>(finger),
                                          static_cast<HandBone>(bone)),
                        bones.fingers[index_of(side)][finger][bone]);
            }
        }
    }
    if (error) {
        return *error;
    }
    return bones;
}

Result<BodyBones> find_body_bones(const SkinnedMesh& figure, const BodyBones& mapped,
                                  const char* names) {
    return BoneFinder(figure, mapped, names).find();
}

}  // namespace handhold
