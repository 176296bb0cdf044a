#include "systems/rigs/body_bones.hpp"

#include <utility>

namespace handhold {
namespace {

std::size_t depth_of(const SkinnedMesh& figure, std::size_t joint) {
    std::size_t depth = 0;
    for (std::int32_t at = figure.joints[joint].parent; at >= 0;
         at = figure.joints[static_cast<std::size_t>(at)].parent) {
        ++depth;
    }
    return depth;
}

// What a map says first; the rest by names.
class BoneFinder {
  public:
    BoneFinder(const SkinnedMesh& figure, const BodyMap& map) : figure_(figure), map_(map) {}

    Result<BodyBones> find() {
        if (const auto error = find_body_map()) {
            return *error;
        }
        guess();
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            use_last_joints(side);
        }
        if (const auto error = missing()) {
            return *error;
        }
        return bones_;
    }

  private:
    std::optional<FileError> find_body_map() {
        for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                if (auto error = look_up({static_cast<BodyBone>(bone), side})) {
                    return error;
                }
            }
        }
        return std::nullopt;
    }
    bool is_mapped(const BodyJointName& name) const {
        return map_.find(body_joint_text(name)) != map_.end();
    }
    // Nothing where the map says what this joint is.
    std::optional<BodyNameGuess> guess_of(std::size_t joint) const {
        const std::string& name = figure_.joints[joint].name;
        for (const auto& [bone, mapped] : map_) {
            if (mapped == name) {
                return std::nullopt;
            }
        }
        return parse_body_joint_name(name);
    }

    // The joint nearest to the root for each bone; doubtful names only where no other is there.
    void guess() {
        std::map<std::optional<std::size_t>*, std::pair<int, std::size_t>> best;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = guess_of(i);
            if (!guess || is_mapped(guess->name)) {
                continue;
            }
            std::optional<std::size_t>& bone = bones_.at(guess->name);
            const std::pair<int, std::size_t> rank = {guess->doubt, depth_of(figure_, i)};
            if (!bone || rank < best[&bone]) {
                bone = i;
                best[&bone] = rank;
            }
        }
    }

    // Robots have a joint for each axis of a shoulder and a hip: the limb begins at the last.
    void use_last_joints(HandSide side) {
        auto& upper = bones_.at({BodyBone::upper_arm, side});
        const auto& forearm = bones_.limb(side, BodyBone::forearm);
        if (!upper && forearm) {
            upper = last_above({BodyBone::clavicle, side}, *forearm);
        }
        // Meshes are called hands too: the joint is below the forearm.
        if (forearm && !is_mapped({BodyBone::hand, side})) {
            if (const auto hand = first_below({BodyBone::hand, side}, *forearm)) {
                bones_.at({BodyBone::hand, side}) = hand;
            }
        }
        const auto& shin = bones_.limb(side, BodyBone::shin);
        if (shin && !is_mapped({BodyBone::thigh, side})) {
            if (const auto thigh = last_above({BodyBone::thigh, side}, *shin)) {
                bones_.at({BodyBone::thigh, side}) = thigh;
            }
        }
        auto& clavicle = bones_.at({BodyBone::clavicle, side});
        if (clavicle && upper && forearm && are_in_one_place(*clavicle, *upper, *forearm)) {
            clavicle.reset();
        }
    }
    // Beside the length from `upper` to `forearm`.
    bool are_in_one_place(std::size_t joint, std::size_t upper, std::size_t forearm) const {
        constexpr double k_share = 0.003;
        const Vec3& shoulder = place_of(figure_, upper);
        const double arm_m = (place_of(figure_, forearm) - shoulder).norm();
        return (place_of(figure_, joint) - shoulder).norm() <= k_share * arm_m;
    }

    // The last joint of this name above another.
    std::optional<std::size_t> last_above(const BodyJointName& name, std::size_t joint) const {
        for (std::int32_t at = figure_.joints[joint].parent; at >= 0;
             at = figure_.joints[static_cast<std::size_t>(at)].parent) {
            const auto above = static_cast<std::size_t>(at);
            const auto guess = guess_of(above);
            if (guess && guess->name == name) {
                return above;
            }
        }
        return std::nullopt;
    }

    // The one nearest to the root of this name below another.
    std::optional<std::size_t> first_below(const BodyJointName& name, std::size_t joint) const {
        std::optional<std::size_t> first;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = guess_of(i);
            if (guess && guess->name == name && is_below(figure_, i, joint) &&
                (!first || depth_of(figure_, i) < depth_of(figure_, *first))) {
                first = i;
            }
        }
        return first;
    }

    std::optional<FileError> look_up(const BodyJointName& name) {
        const auto entry = map_.find(body_joint_text(name));
        if (entry == map_.end()) {
            return std::nullopt;
        }
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            if (figure_.joints[i].name == entry->second) {
                bones_.at(name) = i;
                return std::nullopt;
            }
        }
        return FileError{figure_.file, "/nodes",
                         "expected a joint \"" + entry->second + "\" for " + entry->first};
    }

    std::optional<FileError> missing() {
        std::string names;
        const auto need = [&](const BodyJointName& name) {
            if (!bones_.at(name)) {
                names += (names.empty() ? "" : ", ") + body_joint_text(name);
            }
        };
        need({BodyBone::head, HandSide::left});
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            need({BodyBone::upper_arm, side});
            need({BodyBone::forearm, side});
            need({BodyBone::hand, side});
        }
        if (names.empty()) {
            return std::nullopt;
        }
        return FileError{figure_.file, "/nodes",
                         "expected joints of a body, found none for " + names};
    }

    const SkinnedMesh& figure_;
    const BodyMap& map_;
    BodyBones bones_;
};

}  // namespace

bool is_below(const SkinnedMesh& figure, std::size_t joint, std::size_t above) {
    std::int32_t at = figure.joints[joint].parent;
    while (at >= 0 && static_cast<std::size_t>(at) != above) {
        at = figure.joints[static_cast<std::size_t>(at)].parent;
    }
    return at >= 0;
}

Result<BodyBones> find_body_bones(const SkinnedMesh& figure, const BodyMap& map) {
    return BoneFinder(figure, map).find();
}

}  // namespace handhold
