#include "engine/io/file_name.hpp"

#include <cstdint>

#include "engine/core/hash.hpp"
#include "engine/core/printable.hpp"

namespace handhold {
namespace {

constexpr std::string_view k_encoded = "/\\%:*?\"'<>|$`;&!~";

void append_hex(std::uint64_t value, unsigned digits, std::string& out) {
    constexpr std::string_view k_digits = "0123456789ABCDEF";
    for (unsigned shift = 4 * digits; shift > 0; shift -= 4) {
        out += k_digits[(value >> (shift - 4)) & 15U];
    }
}

// Number of bytes of the character at `i` if it is kept; 0 if its first byte must be encoded.
std::size_t kept_length(std::string_view name, std::size_t i) {
    const char c = name[i];
    const bool is_first = i == 0;
    const bool is_last = i + 1 == name.size();
    if (k_encoded.find(c) != std::string_view::npos || (is_first && (c == '.' || c == '-')) ||
        ((is_first || is_last) && c == ' ') || (is_last && c == '.')) {
        return 0;
    }
    return printable_length(name.substr(i));
}

}  // namespace

std::string file_name(std::string_view name) {
    constexpr std::size_t k_hash_digits = 16;
    constexpr std::string_view k_hash_mark = "%-";  // no encoded byte begins like this
    if (name.empty()) {
        return "%";
    }
    std::string out;
    // Length of the longest prefix of whole characters that leaves room for a hash.
    std::size_t last_that_fits = 0;
    for (std::size_t i = 0; i < name.size();) {
        if (out.size() + k_hash_mark.size() + k_hash_digits <= k_max_file_name_bytes) {
            last_that_fits = out.size();
        }
        const std::size_t kept = kept_length(name, i);
        if (kept > 0) {
            out += name.substr(i, kept);
            i += kept;
        } else {
            out += '%';
            append_hex(static_cast<std::uint8_t>(name[i]), 2, out);
            ++i;
        }
    }
    if (out.size() <= k_max_file_name_bytes) {
        return out;
    }
    out.resize(last_that_fits);
    out += k_hash_mark;
    append_hex(hash_text(name), k_hash_digits, out);
    return out;
}

bool is_file_name(std::string_view name) { return file_name(name) == name; }

}  // namespace handhold
