#include "game/net/token.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "game/net/hmac.hpp"

namespace handhold {
namespace {

constexpr std::string_view k_token_version = "hh1.";
constexpr std::size_t k_hex_size = 64;
constexpr std::size_t k_longest_name = 32;

std::string hex(const Sha256& sum) {
    constexpr std::string_view k_digits = "0123456789abcdef";
    std::string text;
    for (const std::byte byte : sum) {
        text += k_digits[std::to_integer<std::size_t>(byte >> 4)];
        text += k_digits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
    return text;
}

bool is_name_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
}

// A whole number of digits only.
std::optional<std::int64_t> parse_time(std::string_view text) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool is_number = error == std::errc{} && stop == end && !text.starts_with('-');
    return is_number ? std::optional(value) : std::nullopt;
}

}  // namespace

Result<TokenKey> load_token_key(const std::filesystem::path& path) {
    constexpr std::size_t k_shortest = 32;
    constexpr std::size_t k_longest = 4096;
    Result<std::string> text = read_file(path, k_longest + 1);
    if (!text) {
        return text.error();
    }
    std::string secret = std::move(text.value());
    if (secret.ends_with('\n')) {
        secret.pop_back();
    }
    if (secret.size() < k_shortest || secret.size() > k_longest) {
        return FileError{path.string(), "",
                         "expected a secret of 32 to 4096 bytes, found " +
                             std::to_string(secret.size()) + " bytes"};
    }
    const auto bytes = std::as_bytes(std::span(secret));
    return TokenKey{{bytes.begin(), bytes.end()}};
}

bool is_token_name(std::string_view name) {
    return !name.empty() && name.size() <= k_longest_name &&
           std::ranges::all_of(name, is_name_letter);
}

std::string issue_token(const TokenKey& key, std::string_view name, std::int64_t expires_unix_s) {
    const std::string claim =
        std::string(k_token_version) + std::to_string(expires_unix_s) + "." + std::string(name);
    return claim + "." + hex(hmac_sha256(key.secret, claim));
}

TokenCheck check_token(const TokenKey& key, std::string_view token, std::int64_t now_unix_s) {
    if (!token.starts_with(k_token_version) || token.size() < k_hex_size + 1) {
        return {};
    }
    const std::string_view claim = token.substr(0, token.size() - k_hex_size - 1);
    const std::string_view sum = token.substr(claim.size() + 1);
    // The signature first: nothing else is said about a token that is not ours.
    if (token[claim.size()] != '.' ||
        !is_equal_in_constant_time(sum, hex(hmac_sha256(key.secret, claim)))) {
        return {};
    }
    const std::string_view fields = claim.substr(std::min(claim.size(), k_token_version.size()));
    const std::size_t dot = fields.find('.');
    if (dot == std::string_view::npos) {
        return {};
    }
    const std::optional<std::int64_t> expires = parse_time(fields.substr(0, dot));
    const std::string_view name = fields.substr(dot + 1);
    if (!expires || !is_token_name(name)) {
        return {};
    }
    return {now_unix_s >= *expires ? TokenState::expired : TokenState::good, std::string(name)};
}

}  // namespace handhold
