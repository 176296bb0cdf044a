#pragma once

#include <memory>
#include <string>

#include "game/net/transport.hpp"

// The transports that this program may have been built with: open_listener and open_link choose
// among them.
namespace handhold {

// A connection that is closed here has so long to send its queue.
inline constexpr double k_close_within_s = 0.5;

// A listener whose datagrams another one may wait for.
class DatagramListener : public Listener {
  public:
    // A socket that is readable while something waits to be polled.
    virtual int descriptor() const = 0;
    // Seconds until `poll` has something to do besides.
    virtual double due_in_s() const = 0;
};

bool has_websocket();
// `descriptor`: `poll` also ends its waiting while that one is readable. -1: none.
Result<std::unique_ptr<Listener>> open_websocket_listener(const ListenerSettings& settings,
                                                          int descriptor = -1);
Result<std::unique_ptr<Link>> open_websocket_link(const std::string& url);

bool has_quic();
Result<std::unique_ptr<DatagramListener>> open_quic_listener(const ListenerSettings& settings);
Result<std::unique_ptr<Link>> open_quic_link(const std::string& url);

}  // namespace handhold
