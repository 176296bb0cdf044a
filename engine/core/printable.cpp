#include "engine/core/printable.hpp"

#include <cstdint>
#include <vector>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

std::uint8_t byte_at(std::string_view text, std::size_t i) {
    return static_cast<std::uint8_t>(text[i]);
}

// Length in bytes of a UTF-8 character with this first byte; 0 if no character starts with it.
std::size_t length_from_lead(std::uint8_t lead) {
    if (lead < 0x80U) {
        return 1;
    }
    if (lead >= 0xC2U && lead <= 0xDFU) {
        return 2;
    }
    if (lead >= 0xE0U && lead <= 0xEFU) {
        return 3;
    }
    return lead >= 0xF0U && lead <= 0xF4U ? 4 : 0;
}

bool is_visible(std::uint32_t code) {
    const bool is_control = code < 0x20U || (code >= 0x7FU && code <= 0x9FU);
    const bool is_surrogate = code >= 0xD800U && code <= 0xDFFFU;
    const bool reorders_or_hides = (code >= 0x200BU && code <= 0x200FU) ||
                                   (code >= 0x2028U && code <= 0x202EU) ||
                                   (code >= 0x2060U && code <= 0x206FU) || code == 0xFEFFU;
    return !is_control && !is_surrogate && !reorders_or_hides && code <= 0x10FFFFU;
}

void append_escape(std::uint8_t byte, std::string& out) {
    constexpr std::string_view k_digits = "0123456789abcdef";
    out += "\\x";
    out += k_digits[byte >> 4U];
    out += k_digits[byte & 15U];
}

}  // namespace

std::size_t printable_length(std::string_view text) {
    // Smallest code point, by length.
    constexpr std::uint32_t k_smallest[] = {0, 0, 0x80U, 0x800U, 0x10000U};
    if (text.empty()) {
        return 0;
    }
    const std::size_t length = length_from_lead(byte_at(text, 0));
    if (length == 0 || length > text.size()) {
        return 0;
    }
    std::uint32_t code = length == 1 ? byte_at(text, 0) : byte_at(text, 0) & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte_at(text, i) & 0xC0U) != 0x80U) {
            return 0;
        }
        code = (code << 6U) | (byte_at(text, i) & 0x3FU);
    }
    return code >= k_smallest[length] && is_visible(code) ? length : 0;
}

std::string printable(std::string_view text, std::size_t max_characters) {
    constexpr std::string_view k_cut = "...";
    constexpr std::size_t k_escape_length = 4;
    HH_CHECK(max_characters >= k_escape_length + k_cut.size() + 1, "too short a limit",
             max_characters);
    std::string out;
    std::vector<std::size_t> starts;  // byte where each character of `out` starts
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = printable_length(text.substr(i));
        starts.push_back(out.size());
        if (length > 0) {
            out += text.substr(i, length);
            i += length;
            continue;
        }
        for (std::size_t digit = 1; digit < k_escape_length; ++digit) {
            starts.push_back(out.size() + digit);
        }
        append_escape(byte_at(text, i), out);
        ++i;
    }
    if (starts.size() <= max_characters) {
        return out;
    }
    const std::size_t kept = max_characters - k_cut.size();
    const std::size_t tail = kept / 3;
    return out.substr(0, starts[kept - tail]) + std::string(k_cut) +
           (tail > 0 ? out.substr(starts[starts.size() - tail]) : std::string());
}

}  // namespace handhold
