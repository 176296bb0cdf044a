#pragma once

#include <string>

namespace handhold {

// A bar on standard error while long work goes on; nothing where that is no terminal.
class Progress {
  public:
    explicit Progress(std::string what);
    ~Progress();  // takes the bar away
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(double share);  // [0, 1]; drawn again only where a percent has passed

  private:
    std::string what_;
    bool on_terminal_;
    int percent_ = -1;
};

}  // namespace handhold
