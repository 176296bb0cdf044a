#pragma once

#include <memory>
#include <vector>

#include "tools/lab/lab_scene.hpp"

// The same scenes in Bullet's own world: btDiscreteDynamicsWorld with
// btSequentialImpulseConstraintSolver at its defaults, its joints, its contacts.
namespace handhold::lab {

class BulletRun {
  public:
    // `scene` must outlive the run.
    BulletRun(const LabScene& scene, Holder holder, double hz);
    ~BulletRun();
    BulletRun(const BulletRun&) = delete;
    BulletRun& operator=(const BulletRun&) = delete;

    // One step of 1/hz without sub-steps.
    void step(FrameRecord& record);
    void set_iterations(int count);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Worst error of any joint, metres, at the end of one frame: by the iterations that this frame's
// step was given, from 1.
std::vector<double> bullet_residuals(const LabScene& scene, Holder holder, double hz, int frame);

}  // namespace handhold::lab
