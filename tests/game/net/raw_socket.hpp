#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace handhold::test {

// A client that speaks WebSocket just well enough to be admitted, and sends what the test says.
class RawSocket {
  public:
    // `from`: the address of this end. With `upgrades` it asks for a WebSocket at once.
    explicit RawSocket(int port, const char* from = "127.0.0.1", bool upgrades = true)
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        const int small = 2048;
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof(small));
        const int usual = 1 << 16;
        ::setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &usual, sizeof(usual));
        const sockaddr_in own = place(from, 0);
        const sockaddr_in server = place("127.0.0.1", port);
        is_connected =
            ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) == 0 &&
            ::connect(socket_, reinterpret_cast<const sockaddr*>(&server), sizeof(server)) == 0;
        if (upgrades) {
            write_text(
                "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
                "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: handhold-match\r\n\r\n");
        }
    }
    ~RawSocket() { ::close(socket_); }
    RawSocket(const RawSocket&) = delete;
    RawSocket& operator=(const RawSocket&) = delete;

    void write_text(const std::string& text) { write(std::as_bytes(std::span(text))); }
    // A frame with a mask of zeros. `size` below 126. `first`: 0x82 binary, 0x02 its first piece,
    // 0x00 a further piece, 0x89 a ping.
    static std::vector<std::byte> frame(std::span<const std::byte> message, unsigned first = 0x82) {
        std::vector<std::byte> out = {static_cast<std::byte>(first),
                                      static_cast<std::byte>(0x80U | message.size())};
        out.resize(6);
        out.insert(out.end(), message.begin(), message.end());
        return out;
    }
    void write_frame(std::span<const std::byte> message, unsigned first = 0x82) {
        write(frame(message, first));
    }
    // Sends as much of it as the connection takes. Whole frames of `unit` bytes follow each other.
    void pour(std::span<const std::byte> unit) {
        std::vector<std::byte> many;
        while (many.size() < std::size_t{16} << 10U) {
            many.insert(many.end(), unit.begin(), unit.end());
        }
        for (;;) {
            const std::span<const std::byte> rest =
                std::span<const std::byte>(many).subspan(at_ % many.size());
            const ssize_t sent =
                ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent <= 0) {
                return;
            }
            at_ += static_cast<std::size_t>(sent);
        }
    }
    std::size_t poured() const { return at_; }
    // What has come, at most so much.
    std::string read(std::size_t most = 65536) {
        std::string text(most, ' ');
        const ssize_t size = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
        text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
        is_ended = is_ended || size == 0 || (size < 0 && errno != EAGAIN && errno != EWOULDBLOCK);
        return text;
    }
    bool is_connected = false;
    bool is_ended = false;  // found by read

  private:
    static sockaddr_in place(const char* address, int port) {
        sockaddr_in out{};
        out.sin_family = AF_INET;
        out.sin_port = htons(static_cast<std::uint16_t>(port));
        ::inet_pton(AF_INET, address, &out.sin_addr);
        return out;
    }
    void write(std::span<const std::byte> bytes) {
        is_connected = is_connected && ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
                                           static_cast<ssize_t>(bytes.size());
    }

    int socket_;
    std::size_t at_ = 0;
};

}  // namespace handhold::test
