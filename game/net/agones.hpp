#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "game/net/match_seats.hpp"

namespace handhold {

// Tells Agones' sidecar, over the REST interface of its SDK on this machine, how the server stands.
// A thread of its own sends, so that a sidecar that is slow or absent delays no tick. What could
// not be told is told again every second.
class AgonesReporter {
  public:
    enum class State : std::uint8_t { starting, ready, allocated, shutdown };

    // `told`: gets a line for each change that the sidecar has taken, and for its first failure;
    // called by the thread.
    AgonesReporter(int port, std::function<void(const std::string& line)> told);
    ~AgonesReporter();  // waits a second at most
    AgonesReporter(const AgonesReporter&) = delete;
    AgonesReporter& operator=(const AgonesReporter&) = delete;

    void set(State state);
    // The server is alive: call it in its loop. Without calls for two seconds no health is sent.
    void beat();

  private:
    void run();

    int port_;
    std::function<void(const std::string&)> told_;
    std::mutex mutex_;
    std::condition_variable changed_;
    State wanted_ = State::starting;
    bool has_beat_ = false;
    bool ends_ = false;
    std::thread thread_;  // the last one: it uses the others
};

// What the fleet is told of a server that plays one match. The match begins with the first player
// who has had its state, so whoever leaves before does not use the server up.
class FleetMatch {
  public:
    // `return_s`: a seat waits so long for a person who was cut off.
    explicit FleetMatch(double return_s) : return_s_(return_s) {}
    AgonesReporter::State update(const MatchSeats& seats, double now_s);
    // True once all players have left for good. The server then ends, so that nobody else finds
    // their score: the fleet starts another one.
    bool is_over(double now_s) const { return played_s_ && now_s - *played_s_ > return_s_; }

  private:
    double return_s_;
    std::optional<double> played_s_;  // when somebody played last
};

// The port that Agones sets in AGONES_SDK_HTTP_PORT, or its default.
int agones_port();

}  // namespace handhold
