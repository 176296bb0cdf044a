// In place of hmac_openssl.cpp and hmac_gnutls.cpp in a program that was built without a transport.
#include <stdexcept>

#include "game/net/hmac.hpp"

namespace handhold {

Sha256 hmac_sha256(std::span<const std::byte> /*key*/, std::string_view /*text*/) {
    throw std::runtime_error("built without libwebsockets and ngtcp2: no tokens");
}

bool is_equal_in_constant_time(std::string_view /*a*/, std::string_view /*b*/) { return false; }

std::uint64_t secret_number() { return 0; }

}  // namespace handhold
