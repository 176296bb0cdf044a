#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <netinet/in.h>
#include <sys/socket.h>

namespace handhold {

// An address and a port of IPv4 or IPv6.
class UdpPlace {
  public:
    UdpPlace() { storage_.ss_family = AF_INET; }
    explicit UdpPlace(const sockaddr* address);
    // Any address of this machine, any port. `family`: AF_INET or AF_INET6.
    static UdpPlace any(sa_family_t family);

    sa_family_t family() const { return storage_.ss_family; }
    sockaddr* data() { return reinterpret_cast<sockaddr*>(&storage_); }
    const sockaddr* data() const { return reinterpret_cast<const sockaddr*>(&storage_); }
    socklen_t size() const {
        return family() == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
    }
    static constexpr socklen_t most_size() { return sizeof(sockaddr_storage); }
    std::string text() const;  // the numeric address; no port
    int port() const { return ntohs(port_bytes()); }
    void set_port(int port) { port_bytes() = htons(static_cast<std::uint16_t>(port)); }
    bool operator==(const UdpPlace& other) const;

  private:
    std::span<const std::byte> address_bytes() const;
    // Both families keep the port at the same place.
    in_port_t& port_bytes() { return reinterpret_cast<sockaddr_in*>(&storage_)->sin_port; }
    in_port_t port_bytes() const {
        return reinterpret_cast<const sockaddr_in*>(&storage_)->sin_port;
    }

    sockaddr_storage storage_{};
};

// Looks a host's name up, or reads a numeric address: all places of IPv4 and IPv6, in the system's
// order. Empty: there is no such host.
std::vector<UdpPlace> find_places(const std::string& host, int port);

// A UDP socket that never waits, apart from `wait`.
class UdpSocket {
  public:
    // Bound to `place`; with port 0, to any that is free. At :: it takes IPv4 too. The kernel keeps
    // at most about `kernel_buffer_bytes` of unread datagrams; Linux takes twice as much. A peer's
    // socket is told if nobody listens at the other side.
    enum class Side : std::uint8_t { server, peer };
    UdpSocket(const UdpPlace& place, int kernel_buffer_bytes, Side side);
    ~UdpSocket();
    UdpSocket(const UdpSocket&) = delete;
    UdpSocket& operator=(const UdpSocket&) = delete;

    bool is_valid() const { return descriptor_ >= 0; }
    int descriptor() const { return descriptor_; }
    UdpPlace place() const;  // address of this end

    enum class Read : std::uint8_t { datagram, nothing, refused };
    // The next datagram; `bytes` is valid until the next call. `refused`: the other side's system
    // says that nobody listens there.
    Read receive(UdpPlace& from, std::span<const std::uint8_t>& bytes);
    // A datagram that the system does not take is lost.
    void send(const UdpPlace& to, std::span<const std::uint8_t> bytes);
    std::uint64_t sent_datagrams() const { return sent_datagrams_; }
    std::uint64_t sent_bytes() const { return sent_bytes_; }
    // Datagrams that the kernel dropped because its buffer was full; 0 where it does not tell.
    std::uint64_t overflowed_datagrams() const;
    // Until a datagram can be read, or the time is over.
    void wait(double seconds) const;

  private:
    bool take_refusal() const;

    int descriptor_;
    Side side_;
    std::uint64_t sent_datagrams_ = 0;
    std::uint64_t sent_bytes_ = 0;
    std::array<std::uint8_t, 2048> buffer_{};
};

}  // namespace handhold
