// In place of websocket_*.cpp and hmac_openssl.cpp in a program that was built without
// libwebsockets.
#include <stdexcept>

#include "game/net/hmac.hpp"
#include "game/net/transport.hpp"

namespace handhold {
namespace {

FileError no_transport(const std::string& what) {
    return {what, "", "expected a program that was built with libwebsockets (libwebsockets-dev)"};
}

}  // namespace

bool has_network() { return false; }

Result<std::unique_ptr<Listener>> open_listener(const ListenerSettings& settings) {
    return no_transport(settings.address + ":" + std::to_string(settings.port));
}

Result<std::unique_ptr<Link>> open_link(const std::string& url) { return no_transport(url); }

Sha256 hmac_sha256(std::span<const std::byte> /*key*/, std::string_view /*text*/) {
    throw std::runtime_error("built without libwebsockets (libwebsockets-dev): no tokens");
}

bool is_equal_in_constant_time(std::string_view /*a*/, std::string_view /*b*/) { return false; }

std::uint64_t secret_number() { return 0; }

}  // namespace handhold
