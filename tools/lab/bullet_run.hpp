#pragma once

#include <memory>
#include <vector>

#include "tools/lab/lab_scene.hpp"

// Runs a lab scene in Bullet: btDiscreteDynamicsWorld with btSequentialImpulseConstraintSolver at
// its defaults, with Bullet's joints and contacts.
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

// Returns the worst error of joints and hands at the end of frame `frame` (from 0), in metres, for
// 1, 2, ... 50 solver iterations in that frame. Earlier frames use Bullet's default number.
std::vector<double> bullet_residuals(const LabScene& scene, Holder holder, double hz, int frame);

}  // namespace handhold::lab
