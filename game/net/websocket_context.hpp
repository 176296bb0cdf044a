#pragma once

#include <chrono>
#include <cmath>

#include <libwebsockets.h>

// What both ends of a WebSocket share. Only game/net/websocket_* names libwebsockets.
namespace handhold {

inline constexpr const char* k_websocket_protocol = "handhold-match";

inline double monotonic_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// A context of libwebsockets, and the timer that ends its waiting.
class WebSocketContext {
  public:
    explicit WebSocketContext(const lws_context_creation_info& info) {
        lws_set_log_level(0, nullptr);
        alarm_.context = lws_create_context(&info);
    }
    ~WebSocketContext() {
        if (get() != nullptr) {
            lws_sul_schedule(get(), 0, &alarm_.timer, nullptr, LWS_SET_TIMER_USEC_CANCEL);
            lws_context_destroy(get());
        }
    }
    WebSocketContext(const WebSocketContext&) = delete;
    WebSocketContext& operator=(const WebSocketContext&) = delete;

    lws_context* get() const { return alarm_.context; }
    // Handles what is ready; waits for something at most `wait_s`.
    void service(double wait_s) {
        const auto us = static_cast<lws_usec_t>(std::ceil(1e6 * wait_s));
        lws_sul_schedule(get(), 0, &alarm_.timer, on_alarm, us);
        lws_service(get(), 0);
    }

  private:
    struct Alarm {
        lws_sorted_usec_list_t timer{};
        lws_context* context = nullptr;
    };
    // libwebsockets runs the timers that are due, and then waits until the next one. There must be
    // one, so this one is set again.
    static void on_alarm(lws_sorted_usec_list_t* timer) {
        constexpr lws_usec_t k_at_once_us = 500;  // waits are whole milliseconds
        auto* const alarm = static_cast<Alarm*>(static_cast<void*>(timer));
        lws_sul_schedule(alarm->context, 0, timer, on_alarm, k_at_once_us);
    }

    Alarm alarm_;
};

}  // namespace handhold
