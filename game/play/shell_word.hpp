#pragma once

#include <string>
#include <string_view>

namespace handhold {

// Quotes `text` as one word of a POSIX shell's command line, for commands that a user copies from
// the terminal. Plain words stay unchanged. A word with control characters becomes $'...', which
// bash, zsh and ksh support. The word ends at the first NUL, because no argument can contain one.
std::string shell_word(std::string_view text);

}  // namespace handhold
