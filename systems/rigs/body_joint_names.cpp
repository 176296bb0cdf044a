#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "systems/rigs/body_rig_fit.hpp"

namespace handhold {
namespace {

struct NamedBone {
    BodyBone bone;
    const char* text;
};
constexpr std::array<NamedBone, k_body_bone_count> k_bones = {{{BodyBone::trunk, "pelvis"},
                                                               {BodyBone::neck, "neck"},
                                                               {BodyBone::head, "head"},
                                                               {BodyBone::clavicle, "clavicle"},
                                                               {BodyBone::upper_arm, "upper_arm"},
                                                               {BodyBone::forearm, "forearm"},
                                                               {BodyBone::hand, "hand"},
                                                               {BodyBone::thigh, "thigh"},
                                                               {BodyBone::shin, "shin"},
                                                               {BodyBone::foot, "foot"}}};

// What a name has in it; earlier lines go before later ones.
struct Word {
    const char* text;
    BodyBone bone;
    int doubt;
    bool is_whole;  // the name has to end with it
};
constexpr std::array<Word, 27> k_limb_words = {{
    {"forearm", BodyBone::forearm, 0, false}, {"lowerarm", BodyBone::forearm, 0, false},
    {"elbow", BodyBone::forearm, 0, false},   {"upperarm", BodyBone::upper_arm, 0, false},
    {"uparm", BodyBone::upper_arm, 0, false}, {"clavicle", BodyBone::clavicle, 0, false},
    {"collar", BodyBone::clavicle, 0, false}, {"shoulder", BodyBone::clavicle, 0, false},
    {"hand", BodyBone::hand, 0, false},       {"wrist", BodyBone::hand, 0, false},
    {"palm", BodyBone::hand, 0, false},       {"lowerleg", BodyBone::shin, 0, false},
    {"calf", BodyBone::shin, 0, false},       {"shin", BodyBone::shin, 0, false},
    {"knee", BodyBone::shin, 0, false},       {"upleg", BodyBone::thigh, 0, false},
    {"upperleg", BodyBone::thigh, 0, false},  {"thigh", BodyBone::thigh, 0, false},
    {"hip", BodyBone::thigh, 0, false},       {"foot", BodyBone::foot, 0, false},
    {"ankle", BodyBone::foot, 0, false},      {"arm", BodyBone::upper_arm, 1, true},
    {"arm1", BodyBone::upper_arm, 1, true},   {"armlink", BodyBone::upper_arm, 1, true},
    {"leg", BodyBone::shin, 1, true},         {"leg1", BodyBone::shin, 1, true},
    {"leglink", BodyBone::shin, 1, true},
}};
constexpr std::array<Word, 4> k_middle_words = {{
    {"pelvis", BodyBone::trunk, 0, false},
    {"hip", BodyBone::trunk, 0, false},
    {"neck", BodyBone::neck, 0, false},
    {"head", BodyBone::head, 0, true},
}};
// Whatever else stands in such a name, it is no bone of the body; the first ones even inside of a
// word.
constexpr std::array<const char*, 7> k_digits = {"thumb", "index",  "middle", "ring",
                                                 "pinky", "finger", "toe"};
constexpr std::array<const char*, 8> k_others = {"little", "twist",  "end",    "ik",
                                                 "pole",   "target", "helper", "tip"};

// Runs of letters and digits, cut before a capital that follows a small letter; small letters.
// A namespace before the name is left out.
std::vector<std::string> cut_words(std::string_view name) {
    const std::size_t space = name.find_last_of(":|");
    if (space != std::string_view::npos) {
        name.remove_prefix(space + 1);
    }
    std::vector<std::string> words(1);
    bool was_small = false;
    for (const char c : name) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) == 0) {
            words.emplace_back();
            was_small = false;
            continue;
        }
        if (was_small && std::isupper(letter) != 0) {
            words.emplace_back();
        }
        was_small = std::islower(letter) != 0;
        words.back() += static_cast<char>(std::tolower(letter));
    }
    words.erase(std::remove(words.begin(), words.end(), std::string()), words.end());
    return words;
}

template <std::size_t N>
std::optional<BodyNameGuess> find_word(const std::array<Word, N>& list, const std::string& name) {
    for (const Word& word : list) {
        const std::string_view text = word.text;
        if (word.is_whole ? name.ends_with(text) : name.find(text) != std::string::npos) {
            return BodyNameGuess{{word.bone, HandSide::left}, word.doubt};
        }
    }
    return std::nullopt;
}

bool has_digit(const std::string& words) {
    return std::any_of(k_digits.begin(), k_digits.end(),
                       [&](const char* digit) { return words.find(digit) != std::string::npos; });
}

}  // namespace

bool is_digit_name(std::string_view name) {
    std::string words;
    for (const std::string& word : cut_words(name)) {
        words += word;
    }
    return has_digit(words);
}

std::optional<BodyNameGuess> parse_body_joint_name(std::string_view name) {
    std::optional<HandSide> side;
    std::string rest;
    for (const std::string& word : cut_words(name)) {
        if (word == "l" || word == "left") {
            side = HandSide::left;
        } else if (word == "r" || word == "right") {
            side = HandSide::right;
        } else if (std::find(k_others.begin(), k_others.end(), word) != k_others.end()) {
            return std::nullopt;
        } else {
            rest += word;
        }
    }
    if (has_digit(rest)) {
        return std::nullopt;
    }
    if (!side) {
        return find_word(k_middle_words, rest);
    }
    std::optional<BodyNameGuess> guess = find_word(k_limb_words, rest);
    if (guess) {
        guess->name.side = *side;
    }
    return guess;
}

std::string body_joint_text(const BodyJointName& joint) {
    const char* const text = k_bones[static_cast<std::size_t>(joint.bone)].text;
    if (!is_limb(joint.bone)) {
        return text;
    }
    return std::string(joint.side == HandSide::left ? "left_" : "right_") + text;
}

}  // namespace handhold
