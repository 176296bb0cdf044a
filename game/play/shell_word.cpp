#include "game/play/shell_word.hpp"

#include <algorithm>

#include "game/files/file_tools.hpp"

namespace handhold {
namespace {

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./,:+@=").find(c) != std::string_view::npos;
}

bool is_printable(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        if (length == 0) {
            return false;
        }
        text.remove_prefix(length);
    }
    return true;
}

// Writes `text` as $'...'. Octal escapes have exactly three digits, while the shell would read any
// hexadecimal digits that follow \xN.
std::string ansi_c_quoted(std::string_view text) {
    std::string word = "$'";
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        const auto byte = static_cast<unsigned char>(text.front());
        if (text.front() == '\'' || text.front() == '\\') {
            word += '\\';
            word += text.front();
        } else if (length > 0) {
            word += text.substr(0, length);
        } else {
            word += '\\';
            word += static_cast<char>('0' + (byte >> 6U));
            word += static_cast<char>('0' + ((byte >> 3U) & 7U));
            word += static_cast<char>('0' + (byte & 7U));
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return word + "'";
}

}  // namespace

std::string shell_word(std::string_view text) {
    text = text.substr(0, text.find('\0'));
    if (!text.empty() && std::ranges::all_of(text, is_plain)) {
        return std::string(text);
    }
    if (!is_printable(text)) {
        return ansi_c_quoted(text);
    }
    std::string word = "'";
    for (const char c : text) {
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return word + "'";
}

}  // namespace handhold
