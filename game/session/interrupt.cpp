#include "game/session/interrupt.hpp"

#include <csignal>

namespace handhold {
namespace {

constexpr int k_signals[] = {SIGINT, SIGTERM};

volatile std::sig_atomic_t interrupted = 0;

void on_signal(int signal) {
    if (interrupted != 0) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    interrupted = 1;
}

}  // namespace

InterruptGuard::InterruptGuard() : before_() {
    interrupted = 0;
    for (int i = 0; i < 2; ++i) {
        before_[i] = std::signal(k_signals[i], on_signal);
    }
}

InterruptGuard::~InterruptGuard() {
    for (int i = 0; i < 2; ++i) {
        std::signal(k_signals[i], before_[i]);
    }
    interrupted = 0;
}

bool is_interrupted() { return interrupted != 0; }

}  // namespace handhold
