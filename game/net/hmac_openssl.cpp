#include <stdexcept>
#include <tuple>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include "game/net/hmac.hpp"

namespace handhold {

Sha256 hmac_sha256(std::span<const std::byte> key, std::string_view text) {
    std::array<unsigned char, std::tuple_size_v<Sha256>> sum{};
    unsigned int size = 0;
    const auto bytes = std::as_bytes(std::span(text));
    std::array<unsigned char, 1> no_bytes{};
    const void* const input =
        bytes.empty() ? no_bytes.data() : static_cast<const void*>(bytes.data());
    if (HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
             static_cast<const unsigned char*>(input), bytes.size(), sum.data(),
             &size) == nullptr ||
        size != sum.size()) {
        throw std::runtime_error("HMAC-SHA-256 is not available");
    }
    Sha256 out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<std::byte>(sum[i]);
    }
    return out;
}

bool is_equal_in_constant_time(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::uint64_t secret_number() {
    std::array<unsigned char, 8> bytes{};
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
        throw std::runtime_error("no random numbers are available");
    }
    std::uint64_t number = 0;
    for (const unsigned char byte : bytes) {
        number = (number << 8U) | byte;
    }
    return number;
}

}  // namespace handhold
