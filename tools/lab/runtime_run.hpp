#pragma once

#include <memory>

#include "tools/lab/lab_frame.hpp"
#include "tools/lab/lab_scene.hpp"

namespace handhold::lab {

// Plays a scene with the runtime and the given position solver.
class RuntimeRun {
  public:
    // `scene` must outlive the run.
    RuntimeRun(const LabScene& scene, Holder holder, double hz, PositionSolver solver);
    // Runs one frame and records the state at its end.
    void step(FrameRecord& record);
    // Runs the same frame on a discarded copy, which warms the caches and leaves the run unchanged.
    void warm_up();

    // State after the last frame.
    const World& world() const { return world_; }
    const StageStats& stats() const { return stats_; }
    const ShapeLibrary& shapes() const { return shapes_; }

  private:
    void add_bodies();
    void add_joints();
    void add_player(std::size_t index);
    void add_player_hand(std::size_t hold_index);
    void add_kinematic_hand(std::size_t hold_index);
    void drive(World& world, Entity body, const Pose& pose_ws) const;
    void drive_all(World& world, double end_s) const;
    void sample_devices(double end_s);
    void read_bodies(FrameRecord& record) const;
    void read_hands(FrameRecord& record) const;
    double end_s() const { return world_.clock.t_s + dt_s_; }

    const LabScene& scene_;
    Holder holder_;
    double dt_s_;
    PositionSolver solver_;
    ShapeLibrary shapes_;
    World world_;
    StageStats stats_;
    std::unique_ptr<FrameCaches> caches_;
    std::vector<Entity> bodies_;
    std::vector<PlayerEntities> players_;
    std::vector<Entity> kinematic_hands_;  // indexed by LabScene::holds
    std::vector<Entity> hand_joints_;
    std::vector<TrackingSample> samples_;
    std::vector<PlayerInput> inputs_;
};

}  // namespace handhold::lab
