#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

// Sockets of the loopback interface.
namespace handhold::lab {

// Owns a descriptor.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    int get() const { return number_; }
    bool is_open() const { return number_ >= 0; }

  private:
    int number_;
};

inline sockaddr_in loopback_address(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}
// bind, connect and others want the general type.
inline const sockaddr* general(const sockaddr_in& address) {
    return reinterpret_cast<const sockaddr*>(&address);  // NOLINT: how sockets are called
}
inline sockaddr* general(sockaddr_in& address) {
    return reinterpret_cast<sockaddr*>(&address);  // NOLINT: how sockets are called
}

// `type`: SOCK_STREAM or SOCK_DGRAM. Reads and writes do not wait. Not open: no descriptor is left.
inline Descriptor open_socket(int type) {
    return Descriptor(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}
// Takes any free port; 0: it could not.
inline int bind_to_any_port(const Descriptor& socket) {
    sockaddr_in address = loopback_address(0);
    socklen_t size = sizeof(address);
    const bool is_bound = ::bind(socket.get(), general(address), size) == 0 &&
                          ::getsockname(socket.get(), general(address), &size) == 0;
    return is_bound ? ntohs(address.sin_port) : 0;
}

// A clock that only runs forward.
inline double steady_now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace handhold::lab
