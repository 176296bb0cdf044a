#pragma once

namespace handhold {

// While one exists, the first SIGINT or SIGTERM only sets is_interrupted(): long loops then end
// early and their files are written whole. The second ends the process as it would without this.
// One at a time; not from several threads.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();  // restores the handlers
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

  private:
    using Handler = void (*)(int);
    Handler before_[2];
};

// False without an InterruptGuard.
bool is_interrupted();

}  // namespace handhold
