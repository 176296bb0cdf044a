#include "game/net/host_port.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include <arpa/inet.h>

namespace handhold {

std::optional<HostPort> read_host_port(std::string_view text, int default_port) {
    HostPort out{.host = {}, .port = default_port};
    if (text.starts_with('[')) {
        const std::size_t end = text.find(']');
        if (end == std::string_view::npos) {
            return std::nullopt;
        }
        out.host = std::string(text.substr(1, end - 1));
        text.remove_prefix(end + 1);
        if (!is_address(out.host) || !out.is_v6()) {
            return std::nullopt;
        }
    } else {
        const std::size_t end = std::min(text.find(':'), text.size());
        out.host = std::string(text.substr(0, end));
        text.remove_prefix(end);
    }
    if (!text.empty()) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data() + 1, end, out.port);
        if (text.front() != ':' || error != std::errc{} || stop != end) {
            return std::nullopt;
        }
    }
    const bool is_good = !out.host.empty() && out.port >= 1 && out.port <= 65535;
    return is_good ? std::optional(out) : std::nullopt;
}

bool is_address(const std::string& host) {
    in6_addr unused{};
    return inet_pton(AF_INET, host.c_str(), &unused) == 1 ||
           inet_pton(AF_INET6, host.c_str(), &unused) == 1;
}

std::string counted_address(const std::string& address) {
    in6_addr v6{};
    if (inet_pton(AF_INET6, address.c_str(), &v6) != 1) {
        return address;
    }
    std::array<char, INET6_ADDRSTRLEN> text{};
    const std::span<std::uint8_t> bytes(v6.s6_addr);
    if (IN6_IS_ADDR_V4MAPPED(&v6)) {
        inet_ntop(AF_INET, bytes.subspan(12).data(), text.data(), text.size());
        return text.data();
    }
    std::ranges::fill(bytes.subspan(8), std::uint8_t{0});
    inet_ntop(AF_INET6, &v6, text.data(), text.size());
    return std::string(text.data()) + "/64";
}

}  // namespace handhold
