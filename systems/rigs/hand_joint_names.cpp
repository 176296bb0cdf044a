#include "systems/rigs/hand_joint_names.hpp"

#include <array>
#include <cctype>

namespace handhold {
namespace {

std::string in_lower_case(std::string_view name) {
    std::string lower;
    for (const char letter : name) {
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    }
    return lower;
}

bool has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

}  // namespace

std::optional<HandJointName> parse_hand_joint_name(std::string_view name) {
    struct FingerWord {
        const char* word;
        FingerName finger;
    };
    struct BoneWord {
        const char* word;
        HandBone bone;
    };
    constexpr std::array<FingerWord, 6> k_fingers = {{{"thumb", FingerName::thumb},
                                                      {"index", FingerName::index},
                                                      {"middle", FingerName::middle},
                                                      {"ring", FingerName::ring},
                                                      {"little", FingerName::little},
                                                      {"pinky", FingerName::little}}};
    constexpr std::array<BoneWord, 5> k_bones = {{{"metacarpal", HandBone::metacarpal},
                                                  {"proximal", HandBone::proximal},
                                                  {"intermediate", HandBone::intermediate},
                                                  {"distal", HandBone::distal},
                                                  {"tip", HandBone::tip}}};
    const std::string lower = in_lower_case(name);
    for (const FingerWord& finger : k_fingers) {
        for (const BoneWord& bone : k_bones) {
            if (has(lower, finger.word) && has(lower, bone.word)) {
                return HandJointName{finger.finger, bone.bone};
            }
        }
    }
    return std::nullopt;
}

bool is_wrist_name(std::string_view name) { return has(in_lower_case(name), "wrist"); }

std::string hand_joint_text(HandJointName joint) {
    constexpr std::array k_fingers = {"thumb", "index-finger", "middle-finger", "ring-finger",
                                      "pinky-finger"};
    constexpr std::array k_bones = {"-metacarpal", "-phalanx-proximal", "-phalanx-intermediate",
                                    "-phalanx-distal", "-tip"};
    return std::string(k_fingers[static_cast<std::size_t>(joint.finger)]) +
           k_bones[static_cast<std::size_t>(joint.bone)];
}

}  // namespace handhold
