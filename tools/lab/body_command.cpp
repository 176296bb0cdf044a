#include "tools/lab/body_command.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "engine/core/text_file.hpp"
#include "game/play/progress.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/estimate_sizes.hpp"
#include "systems/body/pose_arms.hpp"
#include "tools/lab/body_baselines.hpp"
#include "tools/lab/body_files.hpp"
#include "tools/lab/exit_status.hpp"

namespace handhold::lab {
namespace {

constexpr double k_first_frame_s = 1.0 / 90.0;

// One player at the world's origin, as the columns that the systems need.
class OnePlayer {
  public:
    explicit OnePlayer(std::string estimator) : estimator_(std::move(estimator)) {
        EntityPool pool;
        player_ = pool.create();
        origin_.add(player_);
        head_.add(player_);
        measures_.add(player_);
        calibration_.add(player_);
        size_.add(player_);
        memory_.add(player_);
        estimate_.add(player_);
        arms_.add(player_);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            hands_[side] = pool.create();
            owner_.add(hands_[side], {player_, side == 0 ? HandSide::left : HandSide::right});
            palm_.add(hands_[side]);
            tracking_.add(hands_[side]);
            grab_.add(hands_[side]);
        }
    }

    // Without measures: nobody measured the player, whose size is estimated while playing.
    void start(const std::optional<BodyMeasures>& measures) {
        measures_.at(player_) = measures.value_or(BodyMeasures{});
        size_.at(player_) = {.is_measured = measures.has_value()};
        memory_.at(player_) = {};
        for (const Entity hand : hands_) {
            tracking_.at(hand).state = TrackingState::never;
            palm_.at(hand) = {};
        }
    }

    void step(const BodySample& sample, double dt_s) {
        head_.at(player_).pose_ps = sample.head_ps;
        ArmEstimate& estimate = estimate_.at(player_);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            // The runtime freezes a lost hand; estimate_arms then shows it elsewhere.
            HandTracking& tracking = tracking_.at(hands_[side]);
            if (!sample.is_lost[side]) {
                tracking.pose_ps = sample.hands_ps[side];
                tracking.state = TrackingState::tracked;
            } else if (tracking.state == TrackingState::tracked) {
                tracking.state = TrackingState::lost;
            }
            palm_.at(hands_[side]).pose_ws = tracking.pose_ps;
            estimate.arms[side].hand_ps = tracking.pose_ps;
        }
        head_.at(player_).state = TrackingState::tracked;
        estimate_sizes({.dt_s = dt_s,
                        .origin = origin_,
                        .head = head_,
                        .owner = owner_,
                        .hand = tracking_,
                        .calibration = calibration_,
                        .size = size_,
                        .measures = measures_});
        const BodyMeasures& measures = measures_.at(player_);
        if (estimator_ == "naive") {
            estimate_naive(sample.head_ps, measures, estimate);
        } else if (estimator_ == "talk") {
            estimate_as_talked(sample.head_ps, measures, estimate);
        } else {
            estimate_arms({.dt_s = dt_s,
                           .origin = origin_,
                           .head = head_,
                           .measures = measures_,
                           .owner = owner_,
                           .hand = tracking_,
                           .grab = grab_,
                           .palm = palm_,
                           .memory = memory_,
                           .estimate = estimate_},
                          {});
        }
        pose_arms({.origin = origin_,
                   .measures = measures_,
                   .owner = owner_,
                   .palm = palm_,
                   .estimate = estimate_,
                   .arms = arms_});
    }

    double chest_yaw_deg() const {
        const Vec3& ahead = estimate_.at(player_).facing_ps;
        return arc_tangent2(-ahead.x(), -ahead.z()) * 180.0 / std::numbers::pi;
    }
    const ArmPose& arms() const { return arms_.at(player_); }
    // Length of the arm as drawn, over that of its bones.
    double arm_ratio(HandSide side) const {
        const ArmPose::Arm& arm = arms().arms[index_of(side)];
        const BodyMeasures& measures = measures_.at(player_);
        const double drawn_m = (arm.forearm_ws.position - arm.upper_ws.position).norm() +
                               (arm.hand_ws.position - arm.forearm_ws.position).norm();
        return drawn_m / (measures.upper_arm_m + measures.forearm_m);
    }

  private:
    std::string estimator_;
    Entity player_;
    std::array<Entity, k_hand_count> hands_;
    Column<PlayerOrigin> origin_;
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
};

void append_row(const BodySample& sample, const OnePlayer& player, std::string& text) {
    const auto number = [&text](double value) {
        char cell[40];
        std::snprintf(cell, sizeof cell, ",%.6f", value);
        text += cell;
    };
    const auto point = [&number](const Vec3& p) {
        number(p.x());
        number(p.y());
        number(p.z());
    };
    text += std::to_string(sample.clip);
    number(sample.t_s);
    number(player.chest_yaw_deg());
    for (const ArmPose::Arm& arm : player.arms().arms) {
        point(arm.upper_ws.position);
    }
    for (const ArmPose::Arm& arm : player.arms().arms) {
        point(arm.forearm_ws.position);
    }
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        number(player.arm_ratio(side));
    }
    text += '\n';
}

}  // namespace

std::vector<std::string> estimator_names() { return {"full", "talk", "naive"}; }

int body_command(const BodyOptions& options) {
    const auto samples = load_body_samples(options.in);
    if (!samples) {
        return refuse(samples.error());
    }
    const auto measures = load_body_measures(options.calib);
    if (!measures) {
        return refuse(measures.error());
    }
    std::string text =
        "clip,t,chest_yaw_deg,lshx,lshy,lshz,rshx,rshy,rshz,lelx,lely,lelz,relx,rely,relz,"
        "l_arm_ratio,r_arm_ratio\n";
    OnePlayer player(options.estimator);
    Progress progress("body");
    const std::vector<BodySample>& rows = samples.value();
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const bool first = row == 0 || rows[row - 1].clip != rows[row].clip;
        if (first) {
            const auto found = measures.value().find(rows[row].clip);
            if (found == measures.value().end()) {
                return refuse({options.in.string(), "line " + std::to_string(row + 2),
                               "expected a clip that " + options.calib.string() + " has, found " +
                                   std::to_string(rows[row].clip)});
            }
            player.start(found->second);
        }
        player.step(rows[row], first ? k_first_frame_s : rows[row].t_s - rows[row - 1].t_s);
        append_row(rows[row], player, text);
        progress.show(static_cast<double>(row + 1) / static_cast<double>(rows.size()));
    }
    if (const auto error = write_file_atomically(options.out, text)) {
        return refuse(*error);
    }
    return 0;
}

}  // namespace handhold::lab
