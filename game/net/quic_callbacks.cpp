#include "game/net/quic_callbacks.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include <ngtcp2/ngtcp2_crypto.h>

#include "game/net/quic_connection.hpp"

namespace handhold {
namespace {

// ngtcp2 does not say for which connection it decrypts.
thread_local std::optional<std::uint64_t> authentic_nonce;

int decrypt(std::uint8_t* to, const ngtcp2_crypto_aead* aead, const ngtcp2_crypto_aead_ctx* key,
            const std::uint8_t* from, std::size_t size, const std::uint8_t* nonce,
            std::size_t nonce_size, const std::uint8_t* header, std::size_t header_size) {
    const int result =
        ngtcp2_crypto_decrypt_cb(to, aead, key, from, size, nonce, nonce_size, header, header_size);
    if (std::uint64_t end = 0; result == 0 && nonce_size >= sizeof(end)) {
        // The packet's number is in the last bytes (RFC 9001, 5.3).
        std::memcpy(&end, nonce + nonce_size - sizeof(end), sizeof(end));
        authentic_nonce = end;
    }
    return result;
}

}  // namespace

std::optional<std::uint64_t> take_authentic_nonce() {
    return std::exchange(authentic_nonce, std::nullopt);
}

struct QuicCallbacks {
    static QuicConnection& of(void* user_data) { return *static_cast<QuicConnection*>(user_data); }

    static void keep(QuicConnection& self, std::span<const std::uint8_t> message) {
        std::vector<std::byte>& kept = self.taken_.emplace_back(message.size());
        std::ranges::transform(message, kept.begin(),
                               [](std::uint8_t byte) { return std::byte{byte}; });
    }
    static int refuse(QuicConnection& self) {
        self.has_bad_message_ = true;
        return NGTCP2_ERR_CALLBACK_FAILURE;
    }

    static int stream_data(ngtcp2_conn* connection, std::uint32_t flags, std::int64_t stream,
                           std::uint64_t /*offset*/, const std::uint8_t* data, std::size_t size,
                           void* user_data, void* /*stream_data*/) {
        QuicConnection& self = of(user_data);
        try {
            const bool is_good = self.incoming_.read(
                {data, size}, self.settings_.most_message_bytes,
                [&self](std::span<const std::uint8_t> message) { keep(self, message); });
            if (!is_good || (flags & NGTCP2_STREAM_DATA_FLAG_FIN) != 0) {
                return refuse(self);
            }
        } catch (const std::exception&) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        ngtcp2_conn_extend_max_offset(connection, size);
        return ngtcp2_conn_extend_max_stream_offset(connection, stream, size) == 0
                   ? 0
                   : NGTCP2_ERR_CALLBACK_FAILURE;
    }

    static int datagram(ngtcp2_conn* /*connection*/, std::uint32_t /*flags*/,
                        const std::uint8_t* data, std::size_t size, void* user_data) {
        QuicConnection& self = of(user_data);
        if (size == 0 || size > self.settings_.most_message_bytes) {
            return refuse(self);
        }
        try {
            keep(self, {data, size});
        } catch (const std::exception&) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        return 0;
    }

    static int acknowledged(ngtcp2_conn* /*connection*/, std::int64_t /*stream*/,
                            std::uint64_t offset, std::uint64_t size, void* user_data,
                            void* /*stream_data*/) {
        of(user_data).stream_.acknowledge(offset + size);
        return 0;
    }
    static int datagram_acknowledged(ngtcp2_conn* /*connection*/, std::uint64_t /*id*/,
                                     void* user_data) {
        ++of(user_data).acknowledged_datagrams_;
        return 0;
    }

    static int reset(ngtcp2_conn* /*connection*/, std::int64_t /*stream*/, std::uint64_t /*size*/,
                     std::uint64_t /*code*/, void* user_data, void* /*stream_data*/) {
        return refuse(of(user_data));
    }
    static int stop_sending(ngtcp2_conn* /*connection*/, std::int64_t /*stream*/,
                            std::uint64_t /*code*/, void* user_data, void* /*stream_data*/) {
        return refuse(of(user_data));
    }

    static void random(std::uint8_t* to, std::size_t size, const ngtcp2_rand_ctx* /*context*/) {
        (void)fill_randomly(to, size);
    }

    static int new_id(ngtcp2_conn* /*connection*/, ngtcp2_cid* id, std::uint8_t* token,
                      std::size_t size, void* user_data) {
        QuicConnection& self = of(user_data);
        std::array<std::uint8_t, NGTCP2_MAX_CIDLEN> bytes{};
        if (!fill_randomly(bytes.data(), size)) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        ngtcp2_cid_init(id, bytes.data(), size);
        if (self.settings_.secret == nullptr) {
            return fill_randomly(token, NGTCP2_STATELESS_RESET_TOKENLEN)
                       ? 0
                       : NGTCP2_ERR_CALLBACK_FAILURE;
        }
        const QuicSecret& secret = *self.settings_.secret;
        if (ngtcp2_crypto_generate_stateless_reset_token(token, secret.data(), secret.size(), id) !=
            0) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        return change_id(self, *id, true);
    }
    static int drop_id(ngtcp2_conn* /*connection*/, const ngtcp2_cid* id, void* user_data) {
        return change_id(of(user_data), *id, false);
    }
    static int change_id(QuicConnection& self, const ngtcp2_cid& id, bool belongs) {
        try {
            if (self.settings_.id_changed) {
                self.settings_.id_changed({id.data, id.datalen}, belongs);
            }
        } catch (const std::exception&) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        return 0;
    }

    static int opened(ngtcp2_conn* connection, void* user_data) {
        QuicConnection& self = of(user_data);
        if (!self.tls_.has_protocol()) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        self.is_open_ = true;
        self.wrote_ = 0;  // the handshake's last packet does not wait
        self.has_valid_address_ = true;
        if (self.settings_.secret != nullptr) {
            offer_token(connection, self);
        }
        return 0;
    }
    static int path_validated(ngtcp2_conn* /*connection*/, std::uint32_t /*flags*/,
                              const ngtcp2_path* path, ngtcp2_path_validation_result result,
                              void* user_data) {
        if (result == NGTCP2_PATH_VALIDATION_RESULT_SUCCESS) {
            of(user_data).proven_peer_ = UdpPlace(path->remote.addr);
        }
        return 0;
    }
    static void offer_token(ngtcp2_conn* connection, const QuicConnection& self) {
        std::array<std::uint8_t, NGTCP2_CRYPTO_MAX_REGULAR_TOKENLEN> token{};
        const QuicSecret& secret = *self.settings_.secret;
        const UdpPlace peer = self.peer();
        const ngtcp2_ssize size = ngtcp2_crypto_generate_regular_token(
            token.data(), secret.data(), secret.size(), peer.data(), peer.size(), quic_now());
        if (size > 0) {
            (void)ngtcp2_conn_submit_new_token(connection, token.data(),
                                               static_cast<std::size_t>(size));
        }
    }
    static int token(ngtcp2_conn* /*connection*/, const ngtcp2_vec* token, void* user_data) {
        const QuicConnection& self = of(user_data);
        try {
            if (self.settings_.token_given) {
                self.settings_.token_given({token->base, token->len});
            }
        } catch (const std::exception&) {
            return NGTCP2_ERR_CALLBACK_FAILURE;
        }
        return 0;
    }
};

ngtcp2_callbacks quic_callbacks(bool is_server) {
    ngtcp2_callbacks out{};
    if (is_server) {
        out.recv_client_initial = ngtcp2_crypto_recv_client_initial_cb;
    } else {
        out.client_initial = ngtcp2_crypto_client_initial_cb;
        out.recv_retry = ngtcp2_crypto_recv_retry_cb;
        out.recv_new_token = &QuicCallbacks::token;
    }
    out.recv_crypto_data = ngtcp2_crypto_recv_crypto_data_cb;
    out.encrypt = ngtcp2_crypto_encrypt_cb;
    out.decrypt = &decrypt;
    out.hp_mask = ngtcp2_crypto_hp_mask_cb;
    out.update_key = ngtcp2_crypto_update_key_cb;
    out.delete_crypto_aead_ctx = ngtcp2_crypto_delete_crypto_aead_ctx_cb;
    out.delete_crypto_cipher_ctx = ngtcp2_crypto_delete_crypto_cipher_ctx_cb;
    out.get_path_challenge_data = ngtcp2_crypto_get_path_challenge_data_cb;
    out.version_negotiation = ngtcp2_crypto_version_negotiation_cb;
    out.handshake_completed = &QuicCallbacks::opened;
    out.path_validation = &QuicCallbacks::path_validated;
    out.rand = &QuicCallbacks::random;
    out.get_new_connection_id = &QuicCallbacks::new_id;
    out.remove_connection_id = &QuicCallbacks::drop_id;
    out.recv_stream_data = &QuicCallbacks::stream_data;
    out.acked_stream_data_offset = &QuicCallbacks::acknowledged;
    out.stream_reset = &QuicCallbacks::reset;
    out.stream_stop_sending = &QuicCallbacks::stop_sending;
    out.recv_datagram = &QuicCallbacks::datagram;
    out.ack_datagram = &QuicCallbacks::datagram_acknowledged;
    return out;
}

}  // namespace handhold
