// In place of hmac_openssl.cpp in a program that was built without libwebsockets, which brings
// OpenSSL.
#include <stdexcept>

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include "game/net/hmac.hpp"

namespace handhold {

Sha256 hmac_sha256(std::span<const std::byte> key, std::string_view text) {
    Sha256 out{};
    if (gnutls_hmac_fast(GNUTLS_MAC_SHA256, key.data(), key.size(), text.data(), text.size(),
                         out.data()) != 0) {
        throw std::runtime_error("HMAC-SHA-256 is not available");
    }
    return out;
}

bool is_equal_in_constant_time(std::string_view a, std::string_view b) {
    return a.size() == b.size() && (a.empty() || gnutls_memcmp(a.data(), b.data(), a.size()) == 0);
}

std::uint64_t secret_number() {
    std::uint64_t out = 0;
    if (gnutls_rnd(GNUTLS_RND_RANDOM, &out, sizeof(out)) != 0) {
        throw std::runtime_error("this system gives no random numbers");
    }
    return out;
}

}  // namespace handhold
