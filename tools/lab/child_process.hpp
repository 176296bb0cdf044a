#pragma once

#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <utility>

#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/lab/loopback_socket.hpp"

namespace handhold::lab {

struct NoProcess final : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A copy of this process that does one piece of work. Ends with its parent.
class ChildProcess {
  public:
    // Precondition: this process has one thread. Throws NoProcess.
    template <typename Work>
    explicit ChildProcess(const Work& work) {
        std::fflush(nullptr);
        id_ = ::fork();
        if (id_ < 0) {
            throw NoProcess("expected room for a further process");
        }
        if (id_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            std::_Exit(status_of(work));
        }
    }
    ~ChildProcess() {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
        }
    }
    ChildProcess(ChildProcess&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
    ChildProcess& operator=(ChildProcess&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }

    void interrupt() const {
        if (id_ > 0) {  // -1 would be all processes
            ::kill(id_, SIGTERM);
        }
    }
    // False if it has not ended by then, or not well.
    bool ends_well_within(double wait_s) {
        const double until_s = steady_now_s() + wait_s;
        int status = 0;
        for (;;) {
            const pid_t ended = ::waitpid(id_, &status, WNOHANG);
            if (ended != 0) {
                id_ = -1;
                return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
            }
            if (steady_now_s() > until_s) {
                return false;
            }
            ::usleep(k_look_us);
        }
    }

  private:
    static constexpr useconds_t k_look_us = 5000;

    template <typename Work>
    static int status_of(const Work& work) {
        int status = 1;
        try {
            status = work();
        } catch (const std::exception& error) {
            std::fprintf(stderr, "handhold-lab: %s\n", error.what());
        }
        std::fflush(nullptr);
        return status;
    }

    pid_t id_ = -1;
};

}  // namespace handhold::lab
