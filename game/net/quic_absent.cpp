// In place of quic_*.cpp in a program that was built without ngtcp2 and GnuTLS.
#include "game/net/transport_kinds.hpp"

namespace handhold {
namespace {

FileError no_quic(const std::string& what) {
    return {what, "",
            "expected a program that was built with ngtcp2 and GnuTLS "
            "(libngtcp2-crypto-gnutls-dev)"};
}

}  // namespace

bool has_quic() { return false; }

Result<std::unique_ptr<DatagramListener>> open_quic_listener(const ListenerSettings& settings) {
    return no_quic(settings.address + ":" + std::to_string(settings.port));
}

Result<std::unique_ptr<Link>> open_quic_link(const std::string& url) { return no_quic(url); }

}  // namespace handhold
