#pragma once

#include <string>
#include <string_view>

namespace handhold {

// `text` as one word of a POSIX shell's command line, for commands that a user copies from the
// terminal. Plain words stay as they are. A word with control characters becomes $'...' (bash, zsh,
// ksh) with the controls escaped. NUL ends the word: no argument can hold one.
std::string shell_word(std::string_view text);

}  // namespace handhold
