#include "systems/rigs/body_map.hpp"

#include <array>
#include <utility>
#include <vector>

#include "engine/io/json.hpp"
#include "systems/rigs/body_joint_names.hpp"

namespace handhold {
namespace {

Result<BodyMap> read_body_map(Result<JsonDocument> document) {
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    root.allow_only({"joints"});
    std::vector<std::string> keys;
    for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            keys.push_back(body_joint_text({static_cast<BodyBone>(bone), side}));
        }
    }
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        for (std::size_t joint = 0; joint < k_finger_count * k_hand_bone_count; ++joint) {
            keys.push_back(finger_joint_text(side,
                                             static_cast<FingerName>(joint / k_hand_bone_count),
                                             static_cast<HandBone>(joint % k_hand_bone_count)));
        }
    }
    const std::vector<std::string_view> allowed(keys.begin(), keys.end());
    const JsonValue joints = root["joints"];
    joints.allow_only(allowed);
    BodyMap map;
    for (const std::string& key : keys) {
        if (joints[key].exists()) {
            map[key] = joints[key].text();
        }
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return map;
}

// VRM 1 names the joints of a thumb metacarpal, proximal, distal; VRM 0 names the same joints
// proximal, intermediate, distal.
void add_vrm_fingers(const std::map<std::string, std::string>& humanoid, BodyMap& map) {
    constexpr std::array k_vrm_fingers = {"Thumb", "Index", "Middle", "Ring", "Little"};
    constexpr std::array<std::pair<const char*, HandBone>, 4> k_vrm_bones = {
        {{"Metacarpal", HandBone::metacarpal},
         {"Proximal", HandBone::proximal},
         {"Intermediate", HandBone::intermediate},
         {"Distal", HandBone::distal}}};
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::string of = side == HandSide::left ? "left" : "right";
        const bool is_vrm_0 = humanoid.contains(of + "ThumbIntermediate");
        for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
            for (const auto& [text, bone] : k_vrm_bones) {
                const auto entry = humanoid.find(of + k_vrm_fingers[finger] + text);
                if (entry == humanoid.end()) {
                    continue;
                }
                const auto name = static_cast<FingerName>(finger);
                const bool is_one_further = is_vrm_0 && name == FingerName::thumb &&
                                            bone > HandBone::metacarpal && bone < HandBone::distal;
                const auto named =
                    is_one_further ? static_cast<HandBone>(static_cast<int>(bone) - 1) : bone;
                map[finger_joint_text(side, name, named)] = entry->second;
            }
        }
    }
}

}  // namespace

Result<BodyMap> load_body_map(const std::filesystem::path& path) {
    return read_body_map(JsonDocument::load(path));
}

Result<BodyMap> parse_body_map(std::string_view text, const std::string& file) {
    return read_body_map(JsonDocument::parse(text, file));
}

BodyMap body_map_of_vrm(const std::map<std::string, std::string>& humanoid) {
    constexpr std::array<std::pair<const char*, BodyBone>, 3> k_middle = {
        {{"hips", BodyBone::trunk}, {"neck", BodyBone::neck}, {"head", BodyBone::head}}};
    constexpr std::array<std::pair<const char*, BodyBone>, 7> k_limbs = {
        {{"Shoulder", BodyBone::clavicle},
         {"UpperArm", BodyBone::upper_arm},
         {"LowerArm", BodyBone::forearm},
         {"Hand", BodyBone::hand},
         {"UpperLeg", BodyBone::thigh},
         {"LowerLeg", BodyBone::shin},
         {"Foot", BodyBone::foot}}};
    BodyMap map;
    const auto add = [&](const std::string& vrm_bone, const BodyJointName& name) {
        if (const auto entry = humanoid.find(vrm_bone); entry != humanoid.end()) {
            map[body_joint_text(name)] = entry->second;
        }
    };
    for (const auto& [text, bone] : k_middle) {
        add(text, {bone, HandSide::left});
    }
    for (const auto& [text, bone] : k_limbs) {
        add(std::string("left") + text, {bone, HandSide::left});
        add(std::string("right") + text, {bone, HandSide::right});
    }
    add_vrm_fingers(humanoid, map);
    return map;
}

}  // namespace handhold
