#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "game/files/file_tools.hpp"

// Who may join: short-lived tokens "hh1.EXPIRY.NAME.HMAC", signed with a secret that the server and
// whoever issues tokens share. Whoever has a token can join with it until it expires, so it is sent
// over wss:// or a network that is trusted.
namespace handhold {

struct TokenKey {
    std::vector<std::byte> secret;
};
// Reads a secret of 32 to 4096 bytes. A line break at its end is no part of it.
Result<TokenKey> load_token_key(const std::filesystem::path& path);

// True for 1 to 32 letters, digits, "-" and "_": the name of a person in a token.
bool is_token_name(std::string_view name);
// A token for that person. Preconditions: is_token_name, the time is not negative.
std::string issue_token(const TokenKey& key, std::string_view name, std::int64_t expires_unix_s);

enum class TokenState : std::uint8_t { good, bad, expired };
struct TokenCheck {
    TokenState state = TokenState::bad;
    std::string name;  // empty if the token is bad
};
// Tolerates any text.
TokenCheck check_token(const TokenKey& key, std::string_view token, std::int64_t now_unix_s);

}  // namespace handhold
