#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <libwebsockets.h>
#ifdef __linux__
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#endif
#include <sys/socket.h>

// What the system knows of a connection's socket.
namespace handhold {

// Bytes that were read from a connection, with everything that libwebsockets keeps to itself:
// headers, pings. 0 where the system does not tell.
inline std::uint64_t bytes_read_from(lws* wsi) {
#ifdef __linux__
    tcp_info info{};
    socklen_t size = sizeof(info);
    int unread = 0;
    const int socket = lws_get_socket_fd(wsi);
    if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
        ioctl(socket, FIONREAD, &unread) != 0) {
        return 0;
    }
    const auto received = static_cast<std::uint64_t>(info.tcpi_bytes_received);
    return received - std::min(received, static_cast<std::uint64_t>(std::max(0, unread)));
#else
    (void)wsi;
    return 0;
#endif
}

inline std::string address_of(lws* wsi) {
    std::array<char, 64> text{};
    lws_get_peer_simple(wsi, text.data(), text.size() - 1);
    return text.data();
}

}  // namespace handhold
