#pragma once

#include <cstdint>

#include "components/stats.hpp"
#include "engine/core/profile.hpp"

namespace handhold::stages {

// Adds the duration of its scope to the stage's time, and marks the scope as a zone in traces.
class StageTimer {
  public:
    StageTimer(Stage stage, StageStats& stats)
        : zone_(name_of(stage)),
          stage_us_(stats.stage_us[static_cast<std::size_t>(stage)]),
          begin_ns_(stage_now_ns()) {}
    ~StageTimer() { stage_us_ += 1e-3 * static_cast<double>(stage_now_ns() - begin_ns_); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

  private:
    Zone zone_;
    double& stage_us_;
    std::int64_t begin_ns_;
};

}  // namespace handhold::stages
