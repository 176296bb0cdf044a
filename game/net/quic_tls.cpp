#include "game/net/quic_tls.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <stdexcept>

#include <gnutls/crypto.h>
#include <gnutls/x509.h>
#include <ngtcp2/ngtcp2_crypto_gnutls.h>

#include "game/net/host_port.hpp"

namespace handhold {
namespace {

constexpr const char* k_priorities =
    "NORMAL:-VERS-ALL:+VERS-TLS1.3:-CIPHER-ALL:+AES-128-GCM:+AES-256-GCM:+CHACHA20-POLY1305:"
    "-GROUP-ALL:+GROUP-X25519:+GROUP-SECP256R1:+GROUP-SECP384R1:%DISABLE_TLS13_COMPAT_MODE";
constexpr std::string_view k_protocol = "handhold-match";

struct Key {
    Key() { gnutls_x509_privkey_init(&key); }
    ~Key() { gnutls_x509_privkey_deinit(key); }
    Key(const Key&) = delete;
    Key& operator=(const Key&) = delete;
    gnutls_x509_privkey_t key = nullptr;
};
struct Certificate {
    Certificate() { gnutls_x509_crt_init(&certificate); }
    ~Certificate() { gnutls_x509_crt_deinit(certificate); }
    Certificate(const Certificate&) = delete;
    Certificate& operator=(const Certificate&) = delete;
    gnutls_x509_crt_t certificate = nullptr;
};

void expect(int result, const char* what) {
    if (result < 0) {
        throw std::runtime_error(std::string(what) + ": " + gnutls_strerror(result));
    }
}

// Empty: it cannot be computed.
Fingerprint fingerprint_of(const gnutls_datum_t& der) {
    std::array<std::uint8_t, 32> sum{};
    std::size_t size = sum.size();
    if (gnutls_fingerprint(GNUTLS_DIG_SHA256, &der, sum.data(), &size) < 0) {
        return {};
    }
    constexpr std::string_view k_digits = "0123456789abcdef";
    Fingerprint out;
    for (const std::uint8_t byte : sum) {
        out += k_digits[byte >> 4U];
        out += k_digits[byte & 15U];
    }
    return out;
}

// Valid for ever: peers know it by its fingerprint, and no clock is asked.
void make_certificate(const Key& key, const Certificate& made) {
    constexpr std::time_t k_since = 1577836800;                     // 2020
    constexpr auto k_until = static_cast<std::time_t>(4102444800);  // 2100
    constexpr std::string_view k_name = "handhold serve";
    gnutls_x509_crt_t to = made.certificate;
    expect(gnutls_x509_privkey_generate(key.key, GNUTLS_PK_ECDSA,
                                        GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0),
           "a key");
    std::array<std::uint8_t, 16> serial{};
    expect(fill_randomly(serial.data(), serial.size()) ? 0 : GNUTLS_E_RANDOM_FAILED,
           "a certificate");
    serial[0] &= 0x7fU;
    expect(gnutls_x509_crt_set_version(to, 3), "a certificate");
    expect(gnutls_x509_crt_set_serial(to, serial.data(), serial.size()), "a certificate");
    expect(gnutls_x509_crt_set_activation_time(to, k_since), "a certificate");
    expect(gnutls_x509_crt_set_expiration_time(to, k_until), "a certificate");
    expect(gnutls_x509_crt_set_dn_by_oid(to, GNUTLS_OID_X520_COMMON_NAME, 0, k_name.data(),
                                         static_cast<unsigned>(k_name.size())),
           "a certificate");
    expect(gnutls_x509_crt_set_key(to, key.key), "a certificate");
    expect(gnutls_x509_crt_sign2(to, to, key.key, GNUTLS_DIG_SHA256, 0), "a certificate");
}

Fingerprint use_certificate_made_now(gnutls_certificate_credentials_t credentials) {
    const Key key;
    Certificate made;
    make_certificate(key, made);
    expect(gnutls_certificate_set_x509_key(credentials, &made.certificate, 1, key.key),
           "a certificate");
    gnutls_datum_t der{};
    expect(gnutls_x509_crt_export2(made.certificate, GNUTLS_X509_FMT_DER, &der), "a certificate");
    Fingerprint out = fingerprint_of(der);
    gnutls_free(der.data);
    return out;
}

}  // namespace

Fingerprint read_fingerprint(std::string_view text) {
    Fingerprint out;
    for (const char letter : text) {
        if (letter == ':') {
            continue;
        }
        if (std::isxdigit(static_cast<unsigned char>(letter)) == 0) {
            return {};
        }
        out += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    }
    return out.size() == 64 ? out : Fingerprint();
}

TlsCredentials::TlsCredentials() {
    expect(gnutls_certificate_allocate_credentials(&credentials_), "TLS");
}

TlsCredentials::~TlsCredentials() { gnutls_certificate_free_credentials(credentials_); }

Result<std::unique_ptr<TlsCredentials>> TlsCredentials::of_server(const std::string& certificate,
                                                                  const std::string& key) {
    std::unique_ptr<TlsCredentials> out(new TlsCredentials());
    if (certificate.empty()) {
        out->fingerprint_ = use_certificate_made_now(out->credentials_);
        return out;
    }
    const int result = gnutls_certificate_set_x509_key_file(out->credentials_, certificate.c_str(),
                                                            key.c_str(), GNUTLS_X509_FMT_PEM);
    gnutls_datum_t der{};
    if (result < 0 || gnutls_certificate_get_crt_raw(out->credentials_,
                                                     static_cast<unsigned>(result), 0, &der) < 0) {
        return FileError{certificate, "",
                         "expected a certificate in PEM, with its key in " + key + ": " +
                             gnutls_strerror(std::min(result, 0))};
    }
    out->fingerprint_ = fingerprint_of(der);
    return out;
}

std::unique_ptr<TlsCredentials> TlsCredentials::of_peer(const std::string& host,
                                                        const Fingerprint& fingerprint) {
    std::unique_ptr<TlsCredentials> out(new TlsCredentials());
    out->host_ = host;
    out->fingerprint_ = fingerprint;
    if (fingerprint.empty()) {
        // As OpenSSL does for wss://. None: nobody is trusted.
        // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
        const char* const file = std::getenv("SSL_CERT_FILE");
        if (file != nullptr) {
            (void)gnutls_certificate_set_x509_trust_file(out->credentials_, file,
                                                         GNUTLS_X509_FMT_PEM);
        } else {
            (void)gnutls_certificate_set_x509_system_trust(out->credentials_);
        }
    }
    return out;
}

bool TlsCredentials::is_trusted(gnutls_session_t session) const {
    if (fingerprint_.empty()) {
        unsigned status = 0;
        return gnutls_certificate_verify_peers3(session, host_.c_str(), &status) == 0 &&
               status == 0;
    }
    unsigned count = 0;
    const gnutls_datum_t* const shown = gnutls_certificate_get_peers(session, &count);
    return shown != nullptr && count > 0 && fingerprint_of(*shown) == fingerprint_;
}

TlsSession::TlsSession(const TlsCredentials& credentials, bool is_server, ngtcp2_conn*& connection)
    : credentials_(credentials) {
    reference_.self = this;
    reference_.user_data = static_cast<void*>(&connection);
    reference_.get_conn = [](ngtcp2_crypto_conn_ref* reference) {
        return *static_cast<ngtcp2_conn**>(reference->user_data);
    };
    const unsigned side = is_server ? GNUTLS_SERVER : GNUTLS_CLIENT;
    if (gnutls_init(&session_, side | GNUTLS_NO_END_OF_EARLY_DATA | GNUTLS_NO_AUTO_SEND_TICKET) <
        0) {
        session_ = nullptr;
        return;
    }
    std::string protocol(k_protocol);
    const gnutls_datum_t name{static_cast<unsigned char*>(static_cast<void*>(protocol.data())),
                              static_cast<unsigned>(protocol.size())};
    is_valid_ = gnutls_priority_set_direct(session_, k_priorities, nullptr) == 0 &&
                (is_server ? ngtcp2_crypto_gnutls_configure_server_session(session_)
                           : ngtcp2_crypto_gnutls_configure_client_session(session_)) == 0 &&
                gnutls_credentials_set(session_, GNUTLS_CRD_CERTIFICATE, credentials.get()) == 0 &&
                gnutls_alpn_set_protocols(session_, &name, 1, GNUTLS_ALPN_MANDATORY) == 0;
    gnutls_session_set_ptr(session_, static_cast<ngtcp2_crypto_conn_ref*>(&reference_));
    if (!is_server) {
        gnutls_session_set_verify_function(session_, &TlsSession::check_certificate);
        if (!is_address(credentials.host())) {
            gnutls_server_name_set(session_, GNUTLS_NAME_DNS, credentials.host().data(),
                                   credentials.host().size());
        }
    }
}

TlsSession::~TlsSession() {
    if (session_ != nullptr) {
        gnutls_deinit(session_);
    }
}

int TlsSession::check_certificate(gnutls_session_t session) {
    auto* const reference = static_cast<Reference*>(
        static_cast<ngtcp2_crypto_conn_ref*>(gnutls_session_get_ptr(session)));
    reference->self->is_untrusted_ = !reference->self->credentials_.is_trusted(session);
    return reference->self->is_untrusted_ ? -1 : 0;
}

std::string TlsSession::text_of_alert(std::uint8_t alert) {
    const char* const name = gnutls_alert_get_name(static_cast<gnutls_alert_description_t>(alert));
    return name != nullptr ? name : "failed";
}

bool TlsSession::has_protocol() const {
    gnutls_datum_t chosen{};
    return gnutls_alpn_get_selected_protocol(session_, &chosen) == 0 &&
           std::string_view(static_cast<const char*>(static_cast<const void*>(chosen.data)),
                            chosen.size) == k_protocol;
}

bool fill_randomly(std::uint8_t* to, std::size_t size) {
    return gnutls_rnd(GNUTLS_RND_RANDOM, to, size) == 0;
}

}  // namespace handhold
