#pragma once

#include <string>

#include "tools/lab/lab_scene.hpp"
#include "tools/lab/measure.hpp"

// Output formats of `handhold-lab solve`. They are a contract (docs/reference/lab.md): fields may
// be added, but never renamed or removed.
namespace handhold::lab {

struct RunLabels {
    std::string solver;
    std::string masses;
    std::string holder;
    double hz = 90.0;
    int frames = 0;
    int links = 0;
};

// Residual of one solve after each iteration, metres.
struct ResidualCurve {
    int frame = -1;  // -1: not recorded
    std::vector<double> residual_m;
};

std::string scene_json(const LabScene& scene, Holder holder, const RunLabels& labels,
                       const Measure& measure, const ResidualCurve& curve);

// Lines for every body, player and held hand, frame by frame.
class FrameCsv {
  public:
    explicit FrameCsv(const LabScene& scene);
    void take(int frame, const FrameRecord& record);
    const std::string& text() const { return text_; }

  private:
    const LabScene& scene_;
    std::string text_;
};

}  // namespace handhold::lab
