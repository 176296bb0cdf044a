#pragma once

#include <filesystem>

#include "tools/lab/socket_match.hpp"

namespace handhold::lab {

// `handhold-lab match --sockets SCENE`. Exit status: 0; 2 with one line on standard error if a
// process fails or the file cannot be written; 3 if a hash differs, if a machine's own hands differ
// in more ticks than were filled, or if the run proves nothing: nobody gripped, went back, was
// filled or compared a hash.
int socket_match_command(const SocketMatchOptions& options, const std::filesystem::path& json);

// `handhold-lab proxy`: a SocketProxy until SIGINT or SIGTERM. Prints its port, and at the end what
// passed.
struct ProxyOptions {
    int server_port = 0;
    bool is_udp = false;
    NetworkTraits network;
    std::uint64_t seed = 1;
};
int proxy_command(const ProxyOptions& options);

}  // namespace handhold::lab
