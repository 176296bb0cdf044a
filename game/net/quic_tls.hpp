#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <gnutls/gnutls.h>
#include <ngtcp2/ngtcp2_crypto.h>

#include "game/files/file_tools.hpp"

// TLS 1.3 of QUIC, by GnuTLS. Only game/net/quic_* and hmac_gnutls.cpp name GnuTLS and ngtcp2.
namespace handhold {

// SHA-256 of a certificate, 64 lower-case hexadecimal digits.
using Fingerprint = std::string;
// Reads one, also in upper case and with colons between bytes. Empty: it is none.
Fingerprint read_fingerprint(std::string_view text);

// What one side shows, and whom it trusts. Must outlive its sessions.
class TlsCredentials {
  public:
    // A server's, of two files in PEM. Without them, a key and a certificate made now.
    static Result<std::unique_ptr<TlsCredentials>> of_server(const std::string& certificate,
                                                             const std::string& key);
    // A peer's: trusts the server whose certificate has the fingerprint; without one, servers whose
    // certificate for `host` comes from an authority that this system trusts.
    static std::unique_ptr<TlsCredentials> of_peer(const std::string& host,
                                                   const Fingerprint& fingerprint);
    ~TlsCredentials();
    TlsCredentials(const TlsCredentials&) = delete;
    TlsCredentials& operator=(const TlsCredentials&) = delete;

    // A server's own, or the one that a peer expects.
    const Fingerprint& fingerprint() const { return fingerprint_; }
    gnutls_certificate_credentials_t get() const { return credentials_; }
    bool is_trusted(gnutls_session_t session) const;
    const std::string& host() const { return host_; }

  private:
    TlsCredentials();

    gnutls_certificate_credentials_t credentials_ = nullptr;
    Fingerprint fingerprint_;
    std::string host_;
};

// TLS of one connection.
class TlsSession {
  public:
    // `connection` may still be null; it must stay where it is.
    TlsSession(const TlsCredentials& credentials, bool is_server, ngtcp2_conn*& connection);
    ~TlsSession();
    TlsSession(const TlsSession&) = delete;
    TlsSession& operator=(const TlsSession&) = delete;

    bool is_valid() const { return is_valid_; }
    gnutls_session_t get() const { return session_; }
    // The other side's certificate was refused here.
    bool is_untrusted() const { return is_untrusted_; }
    bool has_fingerprint() const { return !credentials_.fingerprint().empty(); }
    static std::string text_of_alert(std::uint8_t alert);
    // Both sides have agreed on the protocol of matches.
    bool has_protocol() const;

  private:
    struct Reference : ngtcp2_crypto_conn_ref {
        TlsSession* self = nullptr;
    };
    static int check_certificate(gnutls_session_t session);

    const TlsCredentials& credentials_;
    Reference reference_{};
    gnutls_session_t session_ = nullptr;
    bool is_valid_ = false;
    bool is_untrusted_ = false;
};

// False: this system gives no random numbers.
bool fill_randomly(std::uint8_t* to, std::size_t size);

}  // namespace handhold
