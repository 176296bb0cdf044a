// Sources: joint names in files exported from Unity and VRM, Unreal (UE4, UE5, MetaHuman), Mixamo,
// Ready Player Me, Meta, DAZ, MakeHuman, Rigify, Character Creator, 3ds Max Biped, CATS and MMD.
#include "systems/rigs/finger_joint_names.hpp"

#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "systems/rigs/joint_words.hpp"

namespace handhold {
namespace {

struct DigitWord {
    const char* text;
    FingerName finger;
};
// A word means a finger if it begins with one of these texts.
constexpr std::array k_digit_words = {
    DigitWord{"thumb", FingerName::thumb},   DigitWord{"index", FingerName::index},
    DigitWord{"pointer", FingerName::index}, DigitWord{"mid", FingerName::middle},
    DigitWord{"ring", FingerName::ring},     DigitWord{"pinky", FingerName::little},
    DigitWord{"pinkie", FingerName::little}, DigitWord{"little", FingerName::little},
    DigitWord{"親指", FingerName::thumb},    DigitWord{"人指", FingerName::index},
    DigitWord{"人差指", FingerName::index},  DigitWord{"人差し指", FingerName::index},
    DigitWord{"中指", FingerName::middle},   DigitWord{"薬指", FingerName::ring},
    DigitWord{"小指", FingerName::little},
};

struct DigitBoneWord {
    const char* text;
    HandBone bone;
};
// A word means a bone if it contains one of these texts.
constexpr std::array k_digit_bone_words = {
    DigitBoneWord{"metacarp", HandBone::metacarpal},
    DigitBoneWord{"carpal", HandBone::metacarpal},
    DigitBoneWord{"meta", HandBone::metacarpal},
    DigitBoneWord{"proximal", HandBone::proximal},
    DigitBoneWord{"intermed", HandBone::intermediate},
    DigitBoneWord{"medial", HandBone::intermediate},
    DigitBoneWord{"middle", HandBone::intermediate},
    DigitBoneWord{"distal", HandBone::distal},
};
constexpr std::array k_digit_tip_words = {"tip", "end", "nub", "null", "effector", "先"};
// A joint whose name contains one of these words is no bone of a finger.
constexpr std::array k_digit_helper_words = {
    "half",     "mcp",        "pip",     "dip",  "palm",       "twist",  "bulge",  "pad",
    "nail",     "marker",     "knuckle", "axis", "corrective", "part",   "share",  "ctrl",
    "control",  "ik",         "fk",      "mch",  "wgt",        "vis",    "tweak",  "target",
    "pole",     "helper",     "master",  "drv",  "goal",       "socket", "attach", "trigger",
    "collider", "fingernail", "toe",     "foot", "weapon",     "prop"};

// Replaces Japanese digits by Latin ones.
std::string with_latin_digits(std::string_view name) {
    constexpr std::string_view k_before_digit = "\xEF\xBC";  // UTF-8 of U+FF10 is EF BC 90
    constexpr unsigned char k_zero = 0x90;
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name.substr(i, 2) == k_before_digit && i + 2 < name.size()) {
            const auto last = static_cast<unsigned char>(name[i + 2]);
            if (last >= k_zero && last < k_zero + 10) {
                out += static_cast<char>('0' + (last - k_zero));
                i += 2;
                continue;
            }
        }
        out += name[i];
    }
    return out;
}

int number_of(std::string_view digits) {
    int number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return number;
}

// What the words of a name say.
struct ReadName {
    std::optional<FingerName> finger;
    std::optional<HandBone> bone;
    bool is_tip = false;
    bool is_helper = false;
    bool has_finger_word = false;      // "finger" itself
    std::string finger_digits;         // the digits behind it
    std::vector<std::string> numbers;  // all other digits
};

// Removes a finger's text from the front of a word.
std::optional<FingerName> take_finger(std::string& word) {
    for (const DigitWord& digit : k_digit_words) {
        if (word.starts_with(digit.text)) {
            word.erase(0, std::string_view(digit.text).size());
            word.erase(0, word.starts_with("dle") ? 3 : 0);  // "mid", "middle"
            return digit.finger;
        }
    }
    return std::nullopt;
}

void read_word(std::string word, ReadName& read) {
    take_side(word);
    const std::string digits = take_digits(word);
    if (word == "finger" || word == "fingers") {
        read.has_finger_word = true;
        read.finger_digits = digits;
        return;
    }
    if (!read.finger) {
        read.finger = take_finger(word);
    }
    // Numbers before the finger name the figure: "Bip01".
    if (!digits.empty() && (read.finger || read.has_finger_word)) {
        read.numbers.push_back(digits);
    }
    read.is_tip = read.is_tip || contains(k_digit_tip_words, word);
    read.is_helper = read.is_helper || contains(k_digit_helper_words, word);
    for (const DigitBoneWord& bone : k_digit_bone_words) {
        if (!read.bone && word.find(bone.text) != std::string::npos) {
            read.bone = bone.bone;
        }
    }
}

// Fingers without a name. MakeHuman's two numbers count both from 1 ("finger2-1"), Biped's digits
// count both from 0 and leave out the first bone's ("Finger1", "Finger11").
std::optional<FingerJointGuess> count_finger(const ReadName& read) {
    if (read.finger_digits.empty()) {
        return std::nullopt;
    }
    int finger = 0;
    FingerJointGuess guess;
    constexpr int k_most_joints = 5;  // a larger number counts the file's nodes
    if (!read.numbers.empty() && number_of(read.numbers.front()) <= k_most_joints) {
        finger = number_of(read.finger_digits) - 1;
        guess.number = number_of(read.numbers.front());
    } else {
        const std::string_view digits = read.finger_digits;
        finger = number_of(digits.substr(0, 1));
        guess.number = 1 + (digits.size() > 1 ? number_of(digits.substr(1)) : 0);
    }
    if (finger < 0 || finger >= static_cast<int>(k_finger_count)) {
        return std::nullopt;
    }
    guess.finger = static_cast<FingerName>(finger);
    return guess;
}

}  // namespace

std::optional<FingerJointGuess> parse_finger_joint_name(std::string_view name) {
    const std::string latin = with_latin_digits(name);
    ReadName read;
    for (const std::string& word : cut_words(latin)) {
        read_word(word, read);
    }
    if (read.is_helper && !read.is_tip) {
        return std::nullopt;
    }
    std::optional<FingerJointGuess> guess;
    if (read.finger) {
        guess = FingerJointGuess{*read.finger, read.bone, std::nullopt};
        if (!read.finger_digits.empty()) {
            guess->number = number_of(read.finger_digits);
        } else if (!read.numbers.empty()) {
            guess->number = number_of(read.numbers.front());
        }
    } else if (read.has_finger_word) {
        guess = count_finger(read);
    }
    if (guess && read.is_tip) {
        guess->bone = HandBone::tip;
    }
    return guess;
}

}  // namespace handhold
