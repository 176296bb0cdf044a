#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"

// Words in the names of joints.
namespace handhold {

template <std::size_t N>
bool contains(const std::array<const char*, N>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

inline bool is_latin(char c) { return static_cast<unsigned char>(c) < 0x80; }

// Splits a name into words, in lower case and without namespaces ("mixamorig:", "Armature|").
std::vector<std::string> cut_words(std::string_view name);

// Returns the side that a word indicates, and removes that side from the word.
std::optional<HandSide> take_side(std::string& word);

// Returns the digits at the end of a word, and removes them from the word.
std::string take_digits(std::string& word);

// Returns the number at the end of a word, and removes it from the word.
std::optional<int> take_number(std::string& word);

}  // namespace handhold
