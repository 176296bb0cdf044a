#pragma once

#include <cstdint>
#include <optional>

#include <ngtcp2/ngtcp2.h>

namespace handhold {

// What ngtcp2 calls. Its `user_data` is a QuicConnection.
ngtcp2_callbacks quic_callbacks(bool is_server);

// Part of the nonce of the last packet that this thread has authenticated since it asked last: each
// packet of a key has another one. nullopt: there was none.
std::optional<std::uint64_t> take_authentic_nonce();

}  // namespace handhold
