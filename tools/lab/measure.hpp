#pragma once

#include <vector>

#include "tools/lab/lab_scene.hpp"

// Errors of a scene, from poses alone: nothing here asks the solver.
namespace handhold::lab {

struct JointErrors {
    double point_m = 0.0;    // and sliders' limits passed
    double angle_rad = 0.0;  // and hinges' limits passed
};
JointErrors joint_error(const LabJoint& joint, const std::vector<Pose>& poses);

// How far the tracked hand is from its anchor.
double grab_error_m(const LabHold& hold, const Pose& target_ws, const std::vector<Pose>& poses);

// The deepest that boxes and heads are in a plane's half space.
double penetration_m(const LabScene& scene, Holder holder, const std::vector<Pose>& poses);

// Linear and angular (about the world's origin) momentum of what moves freely.
struct Momentum {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    double linear_size = 0.0;  // the sum of the parts' sizes: what residuals are relative to
    double angular_size = 0.0;
};
Momentum momentum(const LabScene& scene, Holder holder, const FrameRecord& frame);

// Worst and 99th percentile over the frames, and the rest of solver.md's figures.
struct Series {
    std::vector<double> values;

    void add(double value) { values.push_back(value); }
    double max() const;
    int worst_frame() const;              // the first with the largest value; -1 without values
    double quantile(double share) const;  // nearest rank; 0 without values
};

class Measure {
  public:
    Measure(const LabScene& scene, Holder holder) : scene_(scene), holder_(holder) {}
    void take(const FrameRecord& frame);

    Series joint_mm;
    Series joint_deg;
    Series grab_mm;
    Series player_mm;
    Series penetration_mm;
    Series step_us;
    Series frame_us;
    Series iterations;
    double momentum_residual = 0.0;
    Figures figures;

  private:
    void take_players(const FrameRecord& frame);
    void take_momentum(const FrameRecord& frame);

    const LabScene& scene_;
    Holder holder_;
    bool is_closed_ = false;
    Momentum closed_;
};

}  // namespace handhold::lab
