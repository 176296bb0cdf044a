// Sources: joint names in files exported from 3ds Max Biped, Mixamo, Unity and VRM, Unreal, Valve,
// Meta, Rigify, AdvancedSkeleton, DAZ, MakeHuman, Character Creator, CATS and MMD.
#include "systems/rigs/body_joint_names.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/joint_words.hpp"

namespace handhold {
namespace {

struct NamedBone {
    BodyBone bone;
    const char* text;
};
constexpr std::array<NamedBone, k_body_bone_count> k_bone_texts = {
    {{BodyBone::trunk, "pelvis"},
     {BodyBone::neck, "neck"},
     {BodyBone::head, "head"},
     {BodyBone::clavicle, "clavicle"},
     {BodyBone::upper_arm, "upper_arm"},
     {BodyBone::forearm, "forearm"},
     {BodyBone::hand, "hand"},
     {BodyBone::thigh, "thigh"},
     {BodyBone::shin, "shin"},
     {BodyBone::foot, "foot"}}};

// A text that indicates a bone if a joint's name contains the text.
struct Word {
    const char* text;
    BodyBone bone;
    int doubt;
    bool is_last;    // true: the name must end with the text
    BodyBone other;  // BodyNameGuess::other; equal to `bone`: no second meaning
};
constexpr Word sure(const char* text, BodyBone bone) { return {text, bone, 0, false, bone}; }
constexpr Word likely(const char* text, BodyBone bone) { return {text, bone, 1, false, bone}; }

// Texts in names of limb joints. If a name contains several of them, the first one in the list
// counts.
constexpr std::array k_limb_words = {
    sure("forearm", BodyBone::forearm),
    sure("lowerarm", BodyBone::forearm),
    sure("lowarm", BodyBone::forearm),
    sure("loarm", BodyBone::forearm),
    sure("armlow", BodyBone::forearm),
    sure("armdown", BodyBone::forearm),
    sure("elbow", BodyBone::forearm),
    sure("upperarm", BodyBone::upper_arm),
    sure("uparm", BodyBone::upper_arm),
    sure("armup", BodyBone::upper_arm),
    sure("shldr", BodyBone::upper_arm),
    sure("humerus", BodyBone::upper_arm),
    sure("bicep", BodyBone::upper_arm),
    sure("clavicle", BodyBone::clavicle),
    sure("collar", BodyBone::clavicle),
    sure("scapula", BodyBone::clavicle),
    Word{"shoulder", BodyBone::clavicle, 1, false, BodyBone::upper_arm},
    sure("hand", BodyBone::hand),
    sure("wrist", BodyBone::hand),
    likely("palm", BodyBone::hand),
    sure("lowerleg", BodyBone::shin),
    sure("lowleg", BodyBone::shin),
    sure("loleg", BodyBone::shin),
    sure("leglow", BodyBone::shin),
    sure("legdown", BodyBone::shin),
    sure("foreleg", BodyBone::shin),
    sure("calf", BodyBone::shin),
    sure("shin", BodyBone::shin),
    sure("knee", BodyBone::shin),
    sure("upleg", BodyBone::thigh),
    sure("upperleg", BodyBone::thigh),
    sure("legup", BodyBone::thigh),
    sure("thigh", BodyBone::thigh),
    sure("femur", BodyBone::thigh),
    likely("hip", BodyBone::thigh),
    likely("buttock", BodyBone::thigh),
    sure("foot", BodyBone::foot),
    sure("ankle", BodyBone::foot),
    Word{"arm", BodyBone::upper_arm, 1, true, BodyBone::upper_arm},
    Word{"leg", BodyBone::shin, 1, true, BodyBone::thigh},
};
constexpr std::array k_middle_words = {
    sure("pelvis", BodyBone::trunk),    sure("lowertorso", BodyBone::trunk),
    sure("lowerbody", BodyBone::trunk), sure("hip", BodyBone::trunk),
    sure("neck", BodyBone::neck),       Word{"head", BodyBone::head, 0, true, BodyBone::head},
};
// Joint names of MMD models. A name without its side is exactly one of these texts.
constexpr std::array k_japanese_limbs = {
    sure("肩", BodyBone::clavicle),  sure("腕", BodyBone::upper_arm),
    sure("ひじ", BodyBone::forearm), sure("肘", BodyBone::forearm),
    sure("手首", BodyBone::hand),    sure("足", BodyBone::thigh),
    sure("ひざ", BodyBone::shin),    sure("膝", BodyBone::shin),
    sure("足首", BodyBone::foot),
};
constexpr std::array k_japanese_middle = {
    sure("下半身", BodyBone::trunk),
    sure("首", BodyBone::neck),
    sure("頭", BodyBone::head),
};
constexpr std::array k_japanese_twists = {
    sure("腕捩", BodyBone::upper_arm),
    sure("腕捩れ", BodyBone::upper_arm),
    sure("手捩", BodyBone::forearm),
    sure("手捩れ", BodyBone::forearm),
};

// A name that contains one of these texts, even inside a word, is a thumb, a finger or a toe.
constexpr std::array<const char*, 9> k_digits = {"thumb",  "index", "middle", "ring",  "pinky",
                                                 "finger", "toe",   "指",     "つま先"};
// A joint whose name contains one of these words is not a bone of the body.
constexpr std::array<const char*, 24> k_others = {
    "little", "end",      "nub",  "tip",     "ik",     "fk",     "ikfk", "pole",
    "target", "helper",   "ctrl", "control", "mch",    "vis",    "wgt",  "tweak",
    "goal",   "effector", "null", "socket",  "attach", "weapon", "prop", "forehead"};
// Words to ignore, because they do not tell the bone.
constexpr std::array<const char*, 11> k_fillers = {"joint", "jnt", "bone", "bn", "link", "bend",
                                                   "def",   "org", "m",    "c",  "jt"};
// A joint whose name contains one of these words gets BodyNameGuess::is_part.
constexpr std::array<const char*, 3> k_parts = {"part", "share", "corrective"};

BodyNameGuess guess_of(const Word& word) {
    return {{word.bone, HandSide::left}, word.doubt, {word.other, HandSide::left}, false};
}

template <std::size_t N>
std::optional<BodyNameGuess> find_word(const std::array<Word, N>& list, const std::string& name) {
    for (const Word& word : list) {
        const std::string_view text = word.text;
        if (word.is_last ? name.ends_with(text) : name.find(text) != std::string::npos) {
            return guess_of(word);
        }
    }
    return std::nullopt;
}

template <std::size_t N>
std::optional<BodyNameGuess> find_whole(const std::array<Word, N>& list, const std::string& name) {
    for (const Word& word : list) {
        if (name == word.text) {
            return guess_of(word);
        }
    }
    return std::nullopt;
}

bool has_digit(const std::string& words) {
    return std::any_of(k_digits.begin(), k_digits.end(),
                       [&](const char* digit) { return words.find(digit) != std::string::npos; });
}

struct CutName {
    std::optional<HandSide> side;
    std::string latin;     // the words in Latin script, joined, without side, digits and k_fillers
    std::string japanese;  // the other words, joined, without side and digits
    std::optional<int> number;  // first number at the end of a word
    bool is_part = false;
    bool is_other = false;
};

CutName cut_name(std::string_view name) {
    CutName cut;
    for (std::string word : cut_words(name)) {
        const bool is_latin_word = is_latin(word.front());
        if (const auto side = take_side(word)) {
            cut.side = side;
        }
        const std::optional<int> number = take_number(word);
        cut.number = cut.number ? cut.number : number;
        if (!is_latin_word) {
            cut.japanese += word;
            continue;
        }
        cut.is_other = cut.is_other || contains(k_others, word);
        if (word.find("twist") != std::string::npos || contains(k_parts, word)) {
            cut.is_part = true;
        }
        if (!contains(k_fillers, word)) {
            cut.latin += word;
        }
    }
    return cut;
}

std::optional<BodyNameGuess> parse_japanese(const CutName& cut) {
    if (!cut.side) {
        return cut.latin.empty() ? find_whole(k_japanese_middle, cut.japanese) : std::nullopt;
    }
    if (auto twist = find_whole(k_japanese_twists, cut.japanese)) {
        twist->is_part = true;
        return twist;
    }
    auto guess = find_whole(k_japanese_limbs, cut.japanese);
    if (guess && !cut.latin.empty()) {  // "左足D" duplicates "左足"
        guess->is_part = true;
    }
    return guess;
}

// "Arm_1", "Arm_2", "Leg_1" and "Leg_2" are counted from the body. Without numbers, "Arm" is the
// upper arm and "Leg" the shin, beside an "UpLeg".
void count_from_body(int number, BodyNameGuess& guess) {
    const bool is_second = number == 2;
    if (guess.name.bone == BodyBone::upper_arm && is_second) {
        guess.name.bone = BodyBone::forearm;
        guess.other.bone = BodyBone::upper_arm;
    } else if (guess.name.bone == BodyBone::shin && !is_second) {
        std::swap(guess.name, guess.other);
    }
}

}  // namespace

bool is_eye_name(const std::string& name) {
    std::string low = name;
    std::transform(low.begin(), low.end(), low.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    });
    return low.ends_with("eye") || low.ends_with("eyes") || low.ends_with("eye_l") ||
           low.ends_with("eye_r") || low.ends_with("eye.l") || low.ends_with("eye.r");
}

bool is_digit_name(std::string_view name) {
    std::string words;
    for (const std::string& word : cut_words(name)) {
        words += word;
    }
    return has_digit(words);
}

std::optional<BodyNameGuess> parse_body_joint_name(std::string_view name) {
    const CutName cut = cut_name(name);
    if (cut.is_other || has_digit(cut.latin) || has_digit(cut.japanese)) {
        return std::nullopt;
    }
    std::optional<BodyNameGuess> guess;
    if (!cut.japanese.empty()) {
        guess = parse_japanese(cut);
    } else {
        guess =
            cut.side ? find_word(k_limb_words, cut.latin) : find_word(k_middle_words, cut.latin);
        if (guess && cut.number && cut.side && guess->doubt > 0) {
            count_from_body(*cut.number, *guess);
        }
    }
    if (guess) {
        guess->name.side = guess->other.side = cut.side.value_or(HandSide::left);
        guess->is_part = guess->is_part || cut.is_part;
    }
    return guess;
}

bool is_spare_name(std::string_view name) {
    const std::vector<std::string> words = cut_words(name);
    return !words.empty() && words.front() == "org";
}

std::string body_joint_text(const BodyJointName& joint) {
    const char* const text = k_bone_texts[static_cast<std::size_t>(joint.bone)].text;
    if (!is_limb(joint.bone)) {
        return text;
    }
    return std::string(joint.side == HandSide::left ? "left_" : "right_") + text;
}

std::string finger_joint_text(HandSide side, FingerName finger, HandBone bone) {
    constexpr std::array k_texts = {"metacarpal", "proximal", "intermediate", "distal", "tip"};
    return std::string(side == HandSide::left ? "left_" : "right_") + finger_text(finger) + "_" +
           k_texts[static_cast<std::size_t>(bone)];
}

}  // namespace handhold
