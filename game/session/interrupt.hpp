#pragma once

namespace handhold {

// While a guard exists, the first SIGINT or SIGTERM only sets is_interrupted(): long loops then end
// early and complete their files. A second signal ends the process as it would without a guard. One
// guard at a time; not from several threads.
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
