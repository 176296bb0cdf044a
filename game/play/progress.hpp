#pragma once

#include <string>

namespace handhold {

// A progress bar on standard error. Does nothing if standard error is not a terminal.
class Progress {
  public:
    explicit Progress(std::string what);
    ~Progress();  // erases the bar
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(double share);  // [0, 1]; redraws once for each per cent

  private:
    std::string what_;
    bool on_terminal_;
    int percent_ = -1;
};

}  // namespace handhold
