#pragma once

#include <array>
#include <optional>
#include <string>

#include "components/arm.hpp"
#include "components/body_clip_state.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/size_estimate.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "systems/rigs/body_clips.hpp"
#include "tools/lab/body_files.hpp"

// A player of `handhold-lab body`.
namespace handhold::lab {

// One player at the world's origin, as the columns that the body's systems need.
class BodyPlayer {
  public:
    // `clips`: the game's. "full": the runtime's systems; other estimators are baselines
    // (body_baselines.hpp).
    BodyPlayer(std::string estimator, BodyClips clips);

    // Begins a recording. Without measures: nobody measured the player, whose size is estimated
    // while playing.
    void start(const std::optional<BodyMeasures>& measures);
    void step(const BodySample& sample, double dt_s);

    double chest_yaw_deg() const;
    // Arms before the clavicles' clip, as tools/lab/body_report scores them.
    const ArmPose& arms() const { return arms_.at(player_); }
    // Length of the arm over that of its bones.
    double arm_ratio(HandSide side) const;

    // Arms, trunk and legs as the game shows them in a frame without surfaces.
    const ArmPose& shown_arms() const { return shown_arms_.at(player_); }
    const BodyMeasures& measures() const { return measures_.at(player_); }
    const SpinePose& shown_spine() const { return shown_spine_.at(player_); }

  private:
    void place_hands(const BodySample& sample);
    void estimate(const BodySample& sample, double dt_s);
    void pose(const Column<ArmEstimate>& estimate, Column<ArmPose>& arms) const;
    void show(double dt_s);

    std::string estimator_;
    BodyClips clips_;
    double t_s_ = 0.0;
    Entity player_;
    std::array<Entity, k_hand_count> hands_;
    Column<PlayerOrigin> origin_;
    Column<PlayerVelocity> velocity_;
    Column<ReferenceVelocity> reference_;
    Column<HeadTracking> head_;
    Column<BodyMeasures> measures_;
    Column<Calibration> calibration_;
    Column<SizeEstimate> size_;
    Column<HandOwner> owner_;
    Column<HandTracking> tracking_;
    Column<Grab> grab_;
    Column<PalmPose> palm_;
    Column<ArmMemory> memory_;
    Column<ArmEstimate> estimate_;
    Column<ArmPose> arms_;
    Column<ArmEstimate> shown_estimate_;
    Column<ArmPose> shown_arms_;
    Column<SpineMemory> spine_memory_;
    Column<SpinePose> shown_spine_;
    Column<BodyClipState> clip_state_;
};

}  // namespace handhold::lab
