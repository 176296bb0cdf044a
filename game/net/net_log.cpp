#include "game/net/net_log.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "game/files/file_tools.hpp"

namespace handhold {
namespace {

bool is_plain_value(std::string_view value) {
    return !value.empty() && std::ranges::none_of(value, [](char c) {
        return c == ' ' || c == '"' || c == '=' || c == '\\';
    });
}

}  // namespace

std::string log_line(std::string_view event, std::initializer_list<NetField> fields) {
    std::string line = "event=" + std::string(event);
    for (const auto& [name, value] : fields) {
        const std::string shown = printable(value);
        line += " " + std::string(name) + "=";
        if (is_plain_value(shown)) {
            line += shown;
            continue;
        }
        line += '"';
        for (const char c : shown) {
            line += c == '"' ? "\\\"" : std::string(1, c);
        }
        line += '"';
    }
    return line;
}

void print_log_line(const std::string& line) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    std::array<char, 32> text{};
    if (gmtime_r(&now, &utc) != nullptr) {
        std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    }
    std::printf("time=%s %s\n", text.data(), line.c_str());
    std::fflush(stdout);
}

}  // namespace handhold
