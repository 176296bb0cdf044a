#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace handhold {

// Largest number of characters that a message quotes from a file.
constexpr std::size_t k_max_quoted = 200;
// Largest number of characters of a name from a file in a message.
constexpr std::size_t k_max_shown_name = 60;

// Returns `text` in a form that is safe in one line of a terminal or log. Every byte of a control
// character, of a character that reorders or hides text (bidirectional overrides, zero-width
// characters, line separators) and of invalid UTF-8 becomes \xNN. Longer texts lose their middle:
// "abc...xyz". The result has at most `max_characters` characters. Precondition: max_characters >=
// 8.
std::string printable(std::string_view text, std::size_t max_characters = k_max_quoted);

// Length in bytes, 1 to 4, of the character at the start of `text`. 0 if it is not valid UTF-8 or
// if printable() would replace it.
std::size_t printable_length(std::string_view text);

}  // namespace handhold
