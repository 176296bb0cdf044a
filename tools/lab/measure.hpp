#pragma once

#include <vector>

#include "tools/lab/lab_scene.hpp"

// Errors of a scene, computed from poses alone, independently of the solver.
namespace handhold::lab {

struct JointErrors {
    double point_m = 0.0;    // also includes how far a slider is beyond its limits
    double angle_rad = 0.0;  // also includes how far a hinge is beyond its limits
};
JointErrors joint_error(const LabJoint& joint, const std::vector<Pose>& poses);

// Distance between the tracked hand and the hand's anchor.
double grab_error_m(const LabHold& hold, const Pose& target_ws, const std::vector<Pose>& poses);

// The largest distance by which a box or head is beyond a plane; 0 if none is.
double penetration_m(const LabScene& scene, Holder holder, const std::vector<Pose>& poses);

// Linear and angular (about the world's origin) momentum of freely moving bodies.
struct Momentum {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    // Sum of the magnitudes of the bodies' momenta; residuals are relative to it.
    double linear_size = 0.0;
    double angular_size = 0.0;
};
Momentum momentum(const LabScene& scene, Holder holder, const FrameRecord& frame);

// One value for each frame, for maximum and quantiles.
struct Series {
    std::vector<double> values;

    void add(double value) { values.push_back(value); }
    double max() const;
    // The first frame with the largest value; -1 without values.
    int worst_frame() const;
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
    // Times leave out the first frame, which allocates and fills caches.
    Series step_us;
    Series solve_us;
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
    bool is_first_ = true;
    Momentum closed_;
};

}  // namespace handhold::lab
