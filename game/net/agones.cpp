#include "game/net/agones.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "game/net/net_log.hpp"
#ifdef __unix__
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#endif

namespace handhold {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr auto k_health_every = std::chrono::seconds(2);
constexpr auto k_again_after = std::chrono::seconds(1);

// True if the sidecar has answered 200. Waits a second at most.
bool post_to_sidecar(int port, std::string_view path) {
#ifdef __unix__
    const int to = ::socket(AF_INET, SOCK_STREAM, 0);
    if (to < 0) {
        return false;
    }
    const timeval limit{1, 0};
    ::setsockopt(to, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit));
    ::setsockopt(to, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockaddr plain{};
    std::memcpy(&plain, &address, sizeof(address));
    const std::string request = "POST " + std::string(path) +
                                " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                                "Content-Length: 2\r\nConnection: close\r\n\r\n{}";
    std::array<char, 64> answer{};
    const bool is_good = ::connect(to, &plain, sizeof(address)) == 0 &&
                         ::send(to, request.data(), request.size(), MSG_NOSIGNAL) ==
                             static_cast<ssize_t>(request.size()) &&
                         ::recv(to, answer.data(), answer.size() - 1, MSG_WAITALL) > 0 &&
                         std::string_view(answer.data()).substr(0, 12).ends_with(" 200");
    ::close(to);
    return is_good;
#else
    (void)port;
    (void)path;
    return false;
#endif
}

std::string_view path_of(AgonesReporter::State state) {
    switch (state) {
        case AgonesReporter::State::ready:
            return "/ready";
        case AgonesReporter::State::allocated:
            return "/allocate";
        case AgonesReporter::State::shutdown:
            return "/shutdown";
        case AgonesReporter::State::starting:
            break;
    }
    return "";
}

}  // namespace

int agones_port() {
    constexpr int k_default = 9358;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
    const char* const text = std::getenv("AGONES_SDK_HTTP_PORT");
    int port = 0;
    if (text != nullptr) {
        std::from_chars(text, text + std::strlen(text), port);
    }
    return port >= 1 && port <= 65535 ? port : k_default;
}

AgonesReporter::State FleetMatch::update(const MatchSeats& seats, double now_s) {
    if (seats.is_played()) {
        played_s_ = now_s;
    }
    return played_s_ || seats.taken() > 0 ? AgonesReporter::State::allocated
                                          : AgonesReporter::State::ready;
}

AgonesReporter::AgonesReporter(int port, std::function<void(const std::string& line)> told)
    : port_(port), told_(std::move(told)), thread_([this] { run(); }) {}

AgonesReporter::~AgonesReporter() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void AgonesReporter::set(State state) {
    const std::lock_guard lock(mutex_);
    if (wanted_ != state) {
        wanted_ = state;
        changed_.notify_one();
    }
}

void AgonesReporter::beat() {
    const std::lock_guard lock(mutex_);
    has_beat_ = true;
}

void AgonesReporter::run() {
    State told = State::starting;
    bool has_failed = false;
    auto next_health = SteadyClock::now();
    auto next_try = next_health;
    for (;;) {
        State wanted = told;
        bool is_alive = false;
        bool ends = false;
        {
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, std::chrono::milliseconds(100),
                              [&] { return ends_ || (wanted_ != told && !has_failed); });
            wanted = wanted_;
            ends = ends_;
            is_alive = has_beat_;
        }
        const auto now = SteadyClock::now();
        if (wanted != told && (now >= next_try || ends)) {
            const std::string path(path_of(wanted));
            const bool is_taken = post_to_sidecar(port_, path);
            if (is_taken) {
                told = wanted;
            }
            if (is_taken || !has_failed) {
                told_(log_line("agones", {{"call", path}, {"taken", is_taken ? "1" : "0"}}));
            }
            has_failed = !is_taken;
            next_try = now + k_again_after;
        }
        if (ends) {
            return;
        }
        if (is_alive && now >= next_health) {
            (void)post_to_sidecar(port_, "/health");
            next_health = now + k_health_every;
            const std::lock_guard lock(mutex_);
            has_beat_ = false;
        }
    }
}

}  // namespace handhold
