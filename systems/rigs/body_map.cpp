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
    return map;
}

}  // namespace handhold
