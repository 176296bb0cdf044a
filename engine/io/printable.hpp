#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace handhold {

// Longest quotation from a file in a message, characters.
constexpr std::size_t k_max_quoted = 200;
// Longest name from a file in a message, characters.
constexpr std::size_t k_max_shown_name = 60;

// `text` as it may stand in one line of a terminal or log: every byte of a control character, of a
// character that reorders or hides text (bidirectional overrides, zero-width characters, line
// separators) and of invalid UTF-8 becomes \xNN. Longer texts lose their middle: "abc...xyz". The
// result has at most `max_characters` characters. Precondition: max_characters >= 8.
std::string printable(std::string_view text, std::size_t max_characters = k_max_quoted);

// The length of the character at the start of `text` in bytes, 1 to 4, if it is valid UTF-8 that
// printable() leaves as it is; else 0.
std::size_t printable_length(std::string_view text);

}  // namespace handhold
