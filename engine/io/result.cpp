#include "engine/io/result.hpp"

#include <cstdint>

namespace handhold {
namespace {

// Bytes of the UTF-8 character at the start of `text`; 0 if there is none. Overlong forms and
// surrogates count as characters: a terminal shows them as a replacement character.
std::size_t character_bytes(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t count = byte(0) < 0x80   ? 1
                              : byte(0) < 0xC2 ? 0
                              : byte(0) < 0xE0 ? 2
                              : byte(0) < 0xF0 ? 3
                              : byte(0) < 0xF5 ? 4
                                               : 0;
    if (count > text.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < count; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) {
            return 0;
        }
    }
    return count;
}

// C0, DEL, C1 (U+0080 to U+009F), line separators (U+2028, U+2029) and bidirectional controls
// (U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069).
bool is_control(std::string_view character) {
    std::uint32_t code = static_cast<unsigned char>(character.front());
    if (character.size() > 1) {
        code &= 0xFFU >> (character.size() + 1);
        for (const char next : character.substr(1)) {
            code = code << 6U | (static_cast<unsigned char>(next) & 0x3FU);
        }
    }
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x200E || code == 0x200F ||
           (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text, std::size_t max_characters) {
    std::string result;
    for (std::size_t shown = 0; !text.empty(); ++shown) {
        if (shown == max_characters) {
            return result + "...";
        }
        const std::size_t count = character_bytes(text);
        if (count == 0) {
            result += '?';
            text.remove_prefix(1);
            continue;
        }
        const std::string_view character = text.substr(0, count);
        result += is_control(character) ? " " : character;
        text.remove_prefix(count);
    }
    return result;
}

std::string FileError::message() const {
    // Paths and our own wording may be longer than what a file may contribute.
    constexpr std::size_t k_max_path_characters = 400;
    constexpr std::size_t k_max_expected_characters = 1000;
    return printable(file, k_max_path_characters) + ": " +
           (place.empty() ? std::string() : printable(place) + ": ") +
           printable(expected, k_max_expected_characters);
}

}  // namespace handhold
