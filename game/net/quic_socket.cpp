#include "game/net/quic_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <fcntl.h>
#ifdef __linux__
#include <linux/errqueue.h>
#include <linux/sock_diag.h>
#endif
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

namespace handhold {

UdpPlace::UdpPlace(const sockaddr* address) {
    storage_.ss_family = address->sa_family;
    std::memcpy(&storage_, address, size());
}

UdpPlace UdpPlace::any(sa_family_t family) {
    UdpPlace out;
    out.storage_.ss_family = family;
    return out;
}

std::span<const std::byte> UdpPlace::address_bytes() const {
    if (family() == AF_INET6) {
        return std::as_bytes(
            std::span(reinterpret_cast<const sockaddr_in6*>(&storage_)->sin6_addr.s6_addr));
    }
    return std::as_bytes(std::span(&reinterpret_cast<const sockaddr_in*>(&storage_)->sin_addr, 1));
}

std::string UdpPlace::text() const {
    std::array<char, INET6_ADDRSTRLEN> text{};
    inet_ntop(family(), address_bytes().data(), text.data(), text.size());
    return text.data();
}

bool UdpPlace::operator==(const UdpPlace& other) const {
    return family() == other.family() && port() == other.port() &&
           std::ranges::equal(address_bytes(), other.address_bytes());
}

std::vector<UdpPlace> find_places(const std::string& host, int port) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    std::vector<UdpPlace> out;
    if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) {
        return out;
    }
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
    for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
        if (at->ai_family == AF_INET || at->ai_family == AF_INET6) {
            out.emplace_back(at->ai_addr).set_port(port);
        }
    }
    return out;
}

UdpSocket::UdpSocket(const UdpPlace& place, int kernel_buffer_bytes, Side side)
    : descriptor_(::socket(place.family(), SOCK_DGRAM, 0)), side_(side) {
    if (descriptor_ < 0) {
        return;
    }
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &kernel_buffer_bytes,
                 sizeof(kernel_buffer_bytes));
#ifdef IP_RECVERR
    // The socket is not connected, so that it survives a change of network. This tells of errors
    // nevertheless.
    const int on = side == Side::peer ? 1 : 0;
    ::setsockopt(descriptor_, IPPROTO_IP, IP_RECVERR, &on, sizeof(on));
    if (place.family() == AF_INET6) {
        ::setsockopt(descriptor_, IPPROTO_IPV6, IPV6_RECVERR, &on, sizeof(on));
    }
#endif
    if (place.family() == AF_INET6) {
        const int only_v6 = 0;
        ::setsockopt(descriptor_, IPPROTO_IPV6, IPV6_V6ONLY, &only_v6, sizeof(only_v6));
    }
    if (::fcntl(descriptor_, F_SETFL, O_NONBLOCK) != 0 ||
        ::bind(descriptor_, place.data(), place.size()) != 0) {
        ::close(descriptor_);
        descriptor_ = -1;
    }
}

UdpSocket::~UdpSocket() {
    if (is_valid()) {
        ::close(descriptor_);
    }
}

UdpPlace UdpSocket::place() const {
    UdpPlace out;
    socklen_t size = UdpPlace::most_size();
    ::getsockname(descriptor_, out.data(), &size);
    return out;
}

UdpSocket::Read UdpSocket::receive(UdpPlace& from, std::span<const std::uint8_t>& bytes) {
    socklen_t size = UdpPlace::most_size();
    const ssize_t got =
        ::recvfrom(descriptor_, buffer_.data(), buffer_.size(), 0, from.data(), &size);
    if (got < 0) {
        return side_ == Side::peer && take_refusal() ? Read::refused : Read::nothing;
    }
    bytes = std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(got));
    return Read::datagram;
}

// Reads what the system tells of datagrams that went nowhere: unread, it would keep the socket
// readable.
bool UdpSocket::take_refusal() const {
    bool is_refused = false;
#ifdef IP_RECVERR
    for (;;) {
        alignas(cmsghdr) std::array<char, 512> control{};
        msghdr told{};
        told.msg_control = control.data();
        told.msg_controllen = control.size();
        if (::recvmsg(descriptor_, &told, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) {
            break;
        }
        for (const cmsghdr* at = CMSG_FIRSTHDR(&told); at != nullptr;
             at = CMSG_NXTHDR(&told, const_cast<cmsghdr*>(at))) {
            sock_extended_err error{};
            if ((at->cmsg_level == IPPROTO_IP && at->cmsg_type == IP_RECVERR) ||
                (at->cmsg_level == IPPROTO_IPV6 && at->cmsg_type == IPV6_RECVERR)) {
                std::memcpy(&error, CMSG_DATA(at), sizeof(error));
                is_refused = is_refused || error.ee_errno == ECONNREFUSED;
            }
        }
    }
#endif
    return is_refused;
}

void UdpSocket::send(const UdpPlace& to, std::span<const std::uint8_t> bytes) {
    ++sent_datagrams_;
    sent_bytes_ += bytes.size();
    (void)::sendto(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL, to.data(), to.size());
}

std::uint64_t UdpSocket::overflowed_datagrams() const {
#ifdef SO_MEMINFO
    std::array<std::uint32_t, SK_MEMINFO_VARS> told{};
    socklen_t size = sizeof(told);
    if (::getsockopt(descriptor_, SOL_SOCKET, SO_MEMINFO, told.data(), &size) == 0) {
        return told[SK_MEMINFO_DROPS];
    }
#endif
    return 0;
}

void UdpSocket::wait(double seconds) const {
    pollfd wanted{descriptor_, POLLIN, 0};
    (void)::poll(&wanted, 1, static_cast<int>(std::ceil(1e3 * seconds)));
}

}  // namespace handhold
