#include "components/body_bones.hpp"

#include <utility>

namespace handhold {
namespace {

constexpr double k_one_place_m = 1e-3;

std::size_t depth_of(const SkinnedMesh& figure, std::size_t joint) {
    std::size_t depth = 0;
    for (std::int32_t at = figure.joints[joint].parent; at >= 0;
         at = figure.joints[static_cast<std::size_t>(at)].parent) {
        ++depth;
    }
    return depth;
}

// Finds bones by their names; what a map says goes before.
class BoneFinder {
  public:
    BoneFinder(const SkinnedMesh& figure, const BodyMap& map) : figure_(figure), map_(map) {}

    Result<BodyBones> find() {
        guess();
        use_last_joints();
        for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                if (const auto error = look_up({static_cast<BodyBone>(bone), side})) {
                    return *error;
                }
            }
        }
        if (const auto error = missing()) {
            return *error;
        }
        return bones_;
    }

  private:
    // The joint nearest to the root for each bone; doubtful names only where no other is there.
    void guess() {
        std::map<std::optional<std::size_t>*, std::pair<int, std::size_t>> best;
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = parse_body_joint_name(figure_.joints[i].name);
            if (!guess) {
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
    void use_last_joints() {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            auto& upper = bones_.at({BodyBone::upper_arm, side});
            const auto& forearm = bones_.limb(side, BodyBone::forearm);
            if (!upper && forearm) {
                upper = last_above({BodyBone::clavicle, side}, *forearm);
            }
            // Meshes are called hands too: the joint is below the forearm.
            if (const auto& arm = bones_.limb(side, BodyBone::forearm)) {
                auto& hand = bones_.at({BodyBone::hand, side});
                if (const auto below = first_below({BodyBone::hand, side}, *arm)) {
                    hand = below;
                }
            }
            auto& thigh = bones_.at({BodyBone::thigh, side});
            if (const auto& shin = bones_.limb(side, BodyBone::shin); thigh && shin) {
                thigh = last_above({BodyBone::thigh, side}, *shin);
            }
            auto& clavicle = bones_.at({BodyBone::clavicle, side});
            if (clavicle && upper &&
                (place_of(figure_, *clavicle) - place_of(figure_, *upper)).norm() < k_one_place_m) {
                clavicle.reset();
            }
        }
    }

    // The last joint of this name above another.
    std::optional<std::size_t> last_above(const BodyJointName& name, std::size_t joint) const {
        for (std::int32_t at = figure_.joints[joint].parent; at >= 0;
             at = figure_.joints[static_cast<std::size_t>(at)].parent) {
            const auto above = static_cast<std::size_t>(at);
            const auto guess = parse_body_joint_name(figure_.joints[above].name);
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
            const auto guess = parse_body_joint_name(figure_.joints[i].name);
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
