#include "tools/lab/socket_proxy.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <netinet/tcp.h>
#include <poll.h>

#include "tools/lab/loopback_socket.hpp"

namespace handhold::lab {
namespace {

constexpr std::size_t k_most_datagram = 65536;
constexpr double k_longest_look_s = 0.001;  // what is due waits at most so long

// Waits for any of the sockets to be readable; at most k_longest_look_s.
void wait_for(std::vector<pollfd>& sockets, double wait_s) {
    const double wait_ms = 1e3 * std::min(wait_s, k_longest_look_s);
    ::poll(sockets.data(), sockets.size(), static_cast<int>(std::lround(wait_ms)));
}

// One socket for all clients, and one for each client towards the server.
class UdpProxy final : public SocketProxy {
  public:
    UdpProxy(Descriptor socket, int port, int server_port, const NetworkTraits& traits,
             std::uint64_t seed)
        : socket_(std::move(socket)),
          server_(loopback_address(server_port)),
          network_(traits, seed) {
        port_ = port;
    }

    void poll(double wait_s) override {
        waiting_ = {{socket_.get(), POLLIN, 0}};
        for (const Flow& flow : flows_) {
            waiting_.push_back({flow.to_server.get(), POLLIN, 0});
        }
        wait_for(waiting_, wait_s);
        const double now_s = steady_now_s();
        receive_from_clients(now_s);
        for (std::size_t i = 0; i < flows_.size(); ++i) {
            receive_from_server(i, now_s);
        }
        network_.deliver(
            now_s, [this](std::size_t from, std::size_t to, std::span<const std::byte> bytes) {
                // Nobody hears of a full buffer: the datagram is lost, as networks do it.
                if (to == k_server) {
                    ::send(flows_[from - 1].to_server.get(), bytes.data(), bytes.size(), 0);
                } else {
                    const sockaddr_in& client = flows_[to - 1].client;
                    ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, general(client),
                             sizeof(client));
                }
            });
        counts_.lost = static_cast<std::uint64_t>(network_.lost());
        counts_.doubled = static_cast<std::uint64_t>(network_.doubled());
        counts_.overtaken = static_cast<std::uint64_t>(network_.overtaken());
    }

  private:
    static constexpr std::size_t k_server = 0;  // place in the network; flow i has i + 1
    struct Flow {
        sockaddr_in client;
        Descriptor to_server;
    };

    void note(std::size_t size) {
        ++counts_.pieces;
        counts_.bytes += size;
    }
    // Place of the client's flow; nullopt: no descriptor is left.
    std::optional<std::size_t> flow_of(const sockaddr_in& client) {
        const auto found = std::ranges::find_if(flows_, [&](const Flow& flow) {
            return flow.client.sin_port == client.sin_port &&
                   flow.client.sin_addr.s_addr == client.sin_addr.s_addr;
        });
        if (found != flows_.end()) {
            return static_cast<std::size_t>(found - flows_.begin()) + 1;
        }
        Descriptor to_server = open_socket(SOCK_DGRAM);
        if (!to_server.is_open() ||
            ::connect(to_server.get(), general(server_), sizeof(server_)) != 0) {
            return std::nullopt;
        }
        flows_.push_back({client, std::move(to_server)});
        ++counts_.flows;
        return flows_.size();
    }
    void receive_from_clients(double now_s) {
        for (;;) {
            sockaddr_in client{};
            socklen_t size = sizeof(client);
            const ssize_t got = ::recvfrom(socket_.get(), buffer_.data(), buffer_.size(), 0,
                                           general(client), &size);
            if (got < 0) {
                return;
            }
            if (const auto place = flow_of(client)) {
                note(static_cast<std::size_t>(got));
                network_.send(*place, k_server,
                              std::span(buffer_).first(static_cast<std::size_t>(got)), now_s);
            }
        }
    }
    void receive_from_server(std::size_t flow, double now_s) {
        for (;;) {
            const ssize_t got =
                ::recv(flows_[flow].to_server.get(), buffer_.data(), buffer_.size(), 0);
            if (got < 0) {
                return;
            }
            note(static_cast<std::size_t>(got));
            network_.send(k_server, flow + 1,
                          std::span(buffer_).first(static_cast<std::size_t>(got)), now_s);
        }
    }

    Descriptor socket_;
    sockaddr_in server_;
    SimulatedNetwork network_;
    std::vector<Flow> flows_;
    std::vector<pollfd> waiting_;
    std::vector<std::byte> buffer_ = std::vector<std::byte>(k_most_datagram);
};

class TcpProxy final : public SocketProxy {
  public:
    TcpProxy(Descriptor listener, int port, int server_port, const NetworkTraits& traits,
             std::uint64_t seed)
        : listener_(std::move(listener)),
          server_(loopback_address(server_port)),
          traits_(traits),
          random_(seed) {
        port_ = port;
    }

    void poll(double wait_s) override {
        waiting_ = {{listener_.get(), POLLIN, 0}};
        for (const Connection& connection : connections_) {
            for (const Way& way : connection.ways) {
                const int number = way.may_read() ? connection.ends[way.from].get() : -1;
                waiting_.push_back({number, POLLIN, 0});
            }
        }
        wait_for(waiting_, wait_s);
        accept();
        const double now_s = steady_now_s();
        for (Connection& connection : connections_) {
            for (Way& way : connection.ways) {
                read(connection, way, now_s);
                write(connection, way, now_s);
            }
        }
        std::erase_if(connections_, [](const Connection& connection) {
            return std::ranges::any_of(connection.ways, [](const Way& way) { return way.is_over; });
        });
    }

  private:
    static constexpr std::size_t k_piece = 1400;
    static constexpr std::size_t k_most_queued = 256;  // pieces; then it is not read
    static constexpr double k_again_s = 0.02;

    struct Piece {
        double due_s = 0.0;
        std::vector<std::byte> bytes;  // empty: the end
        std::size_t written = 0;
    };
    struct Way {
        std::size_t from = 0;
        std::size_t to = 0;
        std::deque<Piece> queue;
        double last_due_s = 0.0;
        bool has_ended = false;  // nothing more is read
        bool is_over = false;    // the end has been passed on, or a side is gone

        bool may_read() const { return !has_ended && queue.size() < k_most_queued; }
    };
    struct Connection {
        std::array<Descriptor, 2> ends;  // client, server
        std::array<Way, 2> ways;
    };

    // Uniform in [0, most); the standard distributions differ between libraries.
    double draw(double most) { return most * static_cast<double>(random_() >> 11) * 0x1p-53; }

    void accept() {
        for (;;) {
            Descriptor client(
                ::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
            if (!client.is_open()) {
                return;
            }
            Descriptor server(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
            if (!server.is_open() ||
                ::connect(server.get(), general(server_), sizeof(server_)) != 0) {
                continue;  // the client sees its connection closed
            }
            ::fcntl(server.get(), F_SETFL, O_NONBLOCK);
            const int at_once = 1;
            for (const Descriptor* end : {&client, &server}) {
                ::setsockopt(end->get(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
            }
            Connection connection{{std::move(client), std::move(server)}, {}};
            connection.ways[0].to = 1;
            connection.ways[1].from = 1;
            connections_.push_back(std::move(connection));
            ++counts_.flows;
        }
    }
    void read(Connection& connection, Way& way, double now_s) {
        while (way.may_read()) {
            Piece piece;
            piece.bytes.resize(k_piece);
            const ssize_t got =
                ::recv(connection.ends[way.from].get(), piece.bytes.data(), k_piece, 0);
            if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
                return;
            }
            way.has_ended = got <= 0;
            piece.bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
            double takes_s = traits_.delay_s + draw(traits_.jitter_s);
            if (draw(1.0) < traits_.loss) {
                takes_s += 2.0 * traits_.delay_s + k_again_s;
                ++counts_.lost;
            }
            ++counts_.pieces;
            counts_.bytes += piece.bytes.size();
            way.last_due_s = std::max(way.last_due_s, now_s + takes_s);
            piece.due_s = way.last_due_s;
            way.queue.push_back(std::move(piece));
        }
    }
    static void write(Connection& connection, Way& way, double now_s) {
        while (!way.queue.empty() && way.queue.front().due_s <= now_s) {
            Piece& piece = way.queue.front();
            if (piece.bytes.empty()) {
                way.is_over = true;
                return;
            }
            const ssize_t sent =
                ::send(connection.ends[way.to].get(), piece.bytes.data() + piece.written,
                       piece.bytes.size() - piece.written, MSG_NOSIGNAL);
            if (sent < 0) {
                way.is_over = errno != EAGAIN && errno != EINTR;
                return;
            }
            piece.written += static_cast<std::size_t>(sent);
            if (piece.written < piece.bytes.size()) {
                return;
            }
            way.queue.pop_front();
        }
    }

    Descriptor listener_;
    sockaddr_in server_;
    NetworkTraits traits_;
    std::mt19937_64 random_;
    std::deque<Connection> connections_;
    std::vector<pollfd> waiting_;
};

}  // namespace

Result<std::unique_ptr<SocketProxy>> open_proxy(ProxyKind kind, int server_port,
                                                const NetworkTraits& traits, std::uint64_t seed) {
    const bool is_tcp = kind == ProxyKind::tcp;
    Descriptor socket = open_socket(is_tcp ? SOCK_STREAM : SOCK_DGRAM);
    const int port = socket.is_open() ? bind_to_any_port(socket) : 0;
    constexpr int k_waiting_connections = 64;
    if (port == 0 || (is_tcp && ::listen(socket.get(), k_waiting_connections) != 0)) {
        return FileError{"127.0.0.1", "", "expected a socket for the proxy, found none"};
    }
    std::unique_ptr<SocketProxy> proxy;
    if (is_tcp) {
        proxy = std::make_unique<TcpProxy>(std::move(socket), port, server_port, traits, seed);
    } else {
        proxy = std::make_unique<UdpProxy>(std::move(socket), port, server_port, traits, seed);
    }
    return proxy;
}

}  // namespace handhold::lab
