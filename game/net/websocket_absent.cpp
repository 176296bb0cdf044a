// In place of websocket_*.cpp in a program that was built without libwebsockets.
#include "game/net/transport_kinds.hpp"

namespace handhold {
namespace {

FileError no_websocket(const std::string& what) {
    return {what, "", "expected a program that was built with libwebsockets (libwebsockets-dev)"};
}

}  // namespace

bool has_websocket() { return false; }

Result<std::unique_ptr<Listener>> open_websocket_listener(const ListenerSettings& settings,
                                                          int /*descriptor*/) {
    return no_websocket(settings.address + ":" + std::to_string(settings.port));
}

Result<std::unique_ptr<Link>> open_websocket_link(const std::string& url) {
    return no_websocket(url);
}

}  // namespace handhold
