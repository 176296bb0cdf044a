#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "game/files/file_tools.hpp"

// Connections that carry a match's messages, whatever they are made of. Everything runs on the
// caller's thread, in poll.
namespace handhold {

// Number of a connection to a listener; never used twice.
using LinkId = std::uint64_t;

enum class Delivery : std::uint8_t {
    reliable,  // never lost, and in order
    newest,    // old ones are dropped while the receiver does not read
};

// Why a connection ended.
enum class LinkEnd : std::uint8_t {
    closed,    // ended by the other side, or by us
    message,   // sent what is no message: too long, or text
    flooding,  // sent more than LinkBudget allows, for seconds
    slow,      // did not read for seconds
};

// What one connection may send: bytes as they arrive, with headers, pings and pieces; pieces count
// as messages. Beyond it nothing is read from it until it has waited.
struct LinkBudget {
    double messages_per_s = 250.0;
    double bytes_per_s = 100e3;
    double burst_s = 0.5;  // both rates may be exceeded by so much
};

struct ListenerSettings {
    std::string address = "127.0.0.1";  // address of the interface that is listened on
    int port = 0;                       // 0: any that is free
    std::size_t most_links = 64;        // further connections of a transport are refused
    std::size_t most_of_address = 48;  // limit for one address, HTTP too; at most 3/4 of most_links
    std::size_t most_message_bytes = 1500;
    int kernel_buffer_bytes =
        1 << 16;                // size of the kernel's send buffer; Linux takes twice as much
    double slow_after_s = 5.0;  // a connection that reads nothing for so long ends
    LinkBudget budget;
    // Files in PEM, for QUIC; empty: a certificate is made, which peers know by its fingerprint.
    std::string certificate;
    std::string key;
};

// Sums over all connections since the start.
struct ListenerCounts {
    std::uint64_t opened = 0;
    std::uint64_t refused = 0;  // beyond most_links or most_of_address
    std::uint64_t received_messages = 0;
    std::uint64_t received_bytes = 0;
    std::uint64_t sent_messages = 0;
    std::uint64_t sent_bytes = 0;
    std::uint64_t dropped = 0;    // messages of Delivery::newest that were never sent
    std::uint64_t throttled = 0;  // times that a connection was not read for a while
    std::uint64_t failed = 0;     // ListenerHandler::failed
    std::uint64_t bad_messages = 0;
    std::uint64_t ended_flooding = 0;
    std::uint64_t ended_slow = 0;
    std::size_t most_queued_bytes = 0;  // largest queue of one connection
    // QUIC only: datagrams of UDP, and bytes in them.
    std::uint64_t received_datagrams = 0;
    std::uint64_t received_datagram_bytes = 0;
    std::uint64_t sent_datagrams = 0;
    std::uint64_t sent_datagram_bytes = 0;
    std::uint64_t stray_datagrams = 0;  // belonged to no connection
    // Lost while their connection was over a budget: with the peer's address, and in its name from
    // others.
    std::uint64_t unread_datagrams = 0;
    std::uint64_t unread_elsewhere = 0;
    // Lost because the system's buffer was full: this thread did not read in time. Linux only.
    std::uint64_t overflowed_datagrams = 0;
    std::uint64_t retries = 0;  // strangers who had to prove their address first
};

struct HttpAnswer {
    int status = 200;
    std::string body;  // plain text
};

// What a listener calls during poll. Must not throw.
class ListenerHandler {
  public:
    // `address`: of the other side, without its port.
    virtual void opened(LinkId link, std::string_view address) = 0;
    virtual void received(LinkId link, std::span<const std::byte> message) = 0;
    // The link does not exist any more.
    virtual void closed(LinkId link, LinkEnd why) = 0;
    // The answer to an HTTP GET.
    virtual HttpAnswer get(std::string_view path) = 0;
    // One of these functions has thrown, or there was no memory. `link`: 0 if it is not known.
    virtual void failed(LinkId link, std::string_view what) = 0;

  protected:
    ~ListenerHandler() = default;
};

// A server's end of all its connections.
class Listener {
  public:
    Listener() = default;
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    virtual int port() const = 0;
    // What peers join by, for each transport.
    virtual std::vector<std::string> urls() const { return {}; }
    // Sends and receives what is possible; waits for that at most `wait_s`.
    virtual void poll(double wait_s, ListenerHandler& handler) = 0;
    // Queues a message. Nothing happens for links that do not exist.
    virtual void send(LinkId link, Delivery delivery, std::span<const std::byte> message) = 0;
    // Bytes that wait to be sent, at most SendQueue::k_most_bytes.
    virtual std::size_t queued_bytes(LinkId link) const = 0;
    // Sends the queue, and ends the connection if the other side does not within half a second.
    virtual void close(LinkId link) = 0;
    virtual const ListenerCounts& counts() const = 0;
};

// False: this program was built without a transport and its cryptography.
bool has_network();

// Listens by every transport that there is: WebSocket on TCP and QUIC on UDP, at the same port.
// Error: the port is taken, a certificate cannot be read, or there is no transport.
Result<std::unique_ptr<Listener>> open_listener(const ListenerSettings& settings);

// What a link calls during poll. Must not throw.
class LinkHandler {
  public:
    virtual void opened() = 0;
    virtual void received(std::span<const std::byte> message) = 0;
    // The connection has ended, or there was none. `why`: one line.
    virtual void closed(std::string_view why) = 0;

  protected:
    ~LinkHandler() = default;
};

// A peer's connection to a server.
class Link {
  public:
    Link() = default;
    virtual ~Link() = default;
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

    virtual void poll(double wait_s, LinkHandler& handler) = 0;
    virtual void send(Delivery delivery, std::span<const std::byte> message) = 0;
    virtual std::size_t queued_bytes() const = 0;
    // Ends the connection once its queue is sent.
    virtual void close() = 0;
};

// Begins to connect to ws://HOST:PORT, wss://HOST:PORT, or quic://HOST:PORT#FINGERPRINT, which
// needs no fingerprint if the server's certificate comes from an authority that this system
// trusts. Error: no such URL or host, or there is no such transport.
Result<std::unique_ptr<Link>> open_link(const std::string& url);

}  // namespace handhold
