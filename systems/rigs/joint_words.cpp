#include "systems/rigs/joint_words.hpp"

#include <charconv>

namespace handhold {
namespace {

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_word_letter(char c) {
    return !is_latin(c) || is_upper(c) || is_lower(c) || (c >= '0' && c <= '9');
}

// True if a word begins at `i`: "leftArm" at A, "LArm" at A, "左腕IK" at I.
bool begins_word(std::string_view name, std::size_t i) {
    const char before = name[i - 1];
    const char c = name[i];
    if (is_latin(before) != is_latin(c)) {
        return true;
    }
    const bool ends_capitals = is_upper(before) && i + 1 < name.size() && is_lower(name[i + 1]);
    return is_upper(c) && (is_lower(before) || ends_capitals);
}

// Removes `text` from the front of `word`, unless nothing would be left. Returns true if it was
// removed.
bool remove_prefix(std::string& word, std::string_view text) {
    if (word.size() > text.size() && word.starts_with(text)) {
        word.erase(0, text.size());
        return true;
    }
    return false;
}

}  // namespace

std::vector<std::string> cut_words(std::string_view name) {
    const std::size_t space = name.find_last_of(":|");
    if (space != std::string_view::npos) {
        name.remove_prefix(space + 1);
    }
    std::vector<std::string> words;
    bool is_open = false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (!is_word_letter(c)) {
            is_open = false;
            continue;
        }
        if (!is_open || begins_word(name, i)) {
            words.emplace_back();
        }
        is_open = true;
        words.back() += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return words;
}

std::optional<HandSide> take_side(std::string& word) {
    constexpr std::array<const char*, 4> k_left = {"l", "left", "lf", "lft"};
    constexpr std::array<const char*, 4> k_right = {"r", "right", "rt", "rgt"};
    if (contains(k_left, word)) {
        word.clear();
        return HandSide::left;
    }
    if (contains(k_right, word)) {
        word.clear();
        return HandSide::right;
    }
    if (remove_prefix(word, "left") || remove_prefix(word, "左")) {
        return HandSide::left;
    }
    if (remove_prefix(word, "right") || remove_prefix(word, "右")) {
        return HandSide::right;
    }
    return std::nullopt;
}

std::string take_digits(std::string& word) {
    std::size_t begin = word.size();
    while (begin > 0 && word[begin - 1] >= '0' && word[begin - 1] <= '9') {
        --begin;
    }
    std::string digits = word.substr(begin);
    word.resize(begin);
    return digits;
}

std::optional<int> take_number(std::string& word) {
    const std::string digits = take_digits(word);
    if (digits.empty()) {
        return std::nullopt;
    }
    int number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return number;
}

}  // namespace handhold
