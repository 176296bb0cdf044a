#pragma once

#include <ngtcp2/ngtcp2.h>

namespace handhold {

// What ngtcp2 calls. Its `user_data` is a QuicConnection.
ngtcp2_callbacks quic_callbacks(bool is_server);

}  // namespace handhold
