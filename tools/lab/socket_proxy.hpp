#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "engine/core/text_file.hpp"
#include "tools/lab/match_network.hpp"

// A network between programs of this machine: a proxy on the loopback interface that delays, drops
// and reorders what passes. For kernels that cannot do it themselves.
namespace handhold::lab {

enum class ProxyKind : std::uint8_t {
    // Every datagram has its own way: NetworkTraits, all of it.
    udp,
    // The order is kept, so whatever is late holds up all behind it. A lost piece is one that comes
    // a round trip and 20 ms later, as if it was sent again. Of NetworkTraits: delay_s, jitter_s
    // and
    // loss.
    tcp,
};

// Sums of both directions. A piece: a datagram, or what one read of a TCP socket gave.
struct ProxyCounts {
    std::uint64_t flows = 0;  // connections; of UDP, addresses of clients
    std::uint64_t pieces = 0;
    std::uint64_t bytes = 0;
    std::uint64_t lost = 0;
    std::uint64_t doubled = 0;    // UDP
    std::uint64_t overtaken = 0;  // UDP: datagrams that a later one has overtaken
};

class SocketProxy {
  public:
    virtual ~SocketProxy() = default;
    SocketProxy(const SocketProxy&) = delete;
    SocketProxy& operator=(const SocketProxy&) = delete;

    // The port of 127.0.0.1 that clients use instead of the server's.
    int port() const { return port_; }
    const ProxyCounts& counts() const { return counts_; }
    // Passes on what is due; waits for more at most `wait_s`.
    virtual void poll(double wait_s) = 0;

  protected:
    SocketProxy() = default;

    int port_ = 0;
    ProxyCounts counts_;
};

// `server_port`: of 127.0.0.1. Error: no socket.
Result<std::unique_ptr<SocketProxy>> open_proxy(ProxyKind kind, int server_port,
                                                const NetworkTraits& traits, std::uint64_t seed);

}  // namespace handhold::lab
