#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace handhold {

// A host's name or numeric address, and a port of TCP or UDP.
struct HostPort {
    std::string host;  // addresses of IPv6 without brackets
    int port = 0;      // 1 to 65535

    bool is_v6() const { return host.find(':') != std::string::npos; }
    // As in URLs: HOST, or [ADDRESS] for IPv6; and with the port.
    std::string host_text() const { return is_v6() ? "[" + host + "]" : host; }
    std::string text() const { return host_text() + ":" + std::to_string(port); }
};

// Reads HOST, HOST:PORT, [ADDRESS] or [ADDRESS]:PORT. `default_port` where none is given; 0: one
// must be. nullopt: the text is none of these.
std::optional<HostPort> read_host_port(std::string_view text, int default_port);

// True for numeric addresses of IPv4 and IPv6.
bool is_address(const std::string& host);

// The part of a numeric address that limits count by. IPv4: all of it, also where IPv6 carries it.
// IPv6: the network, 64 bits, since one host has all addresses of its network.
std::string counted_address(const std::string& address);

}  // namespace handhold
