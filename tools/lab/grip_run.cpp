#include "tools/lab/grip_run.hpp"

#include <limits>

#include "components/tracking.hpp"
#include "engine/core/profile.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/pose_thumb.hpp"
#include "systems/hand/sweep_fingers.hpp"

namespace handhold::lab {
namespace {

constexpr double k_at_once_s = std::numeric_limits<double>::infinity();

// The columns of one hand, and what its stages keep their memory in.
class OneHand {
  public:
    OneHand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist) {
        const Entity hand = entities_.create();
        const Entity body = entities_.create();
        tracking_.add(hand).pressed = true;
        surface_.add(hand);
        offset_.add(hand);
        palm_.add(hand);
        fingers_.add(hand);
        surroundings_.push_back({hand, body, &rig, {}, wrist, {{&mesh, {}}}, 1, true});
    }

    void run(const Tuning& tuning, const GripVariant& variant, GripTimes& us) {
        const auto timed = [](double& sum_us, const auto& stage) {
            const std::int64_t begin_ns = stage_now_ns();
            stage();
            sum_us += 1e-3 * static_cast<double>(stage_now_ns() - begin_ns);
        };
        timed(us.search_us, [&] {
            search_grip({surroundings_, surface_, search_scratch_}, tuning, stats_, variant.palm);
        });
        for (std::int32_t lifts = 0;; ++lifts) {
            const double lift_before_m = offset_.rows().front().lift_m;
            timed(us.palm_us, [&] { constrain(tuning, variant); });
            timed(us.fingers_us, [&] {
                sweep_fingers({k_at_once_s, surroundings_, tracking_, surface_, palm_, offset_,
                               fingers_, traces_, fit_scratch_},
                              tuning, stats_, variant.order);
            });
            if (!variant.sync || offset_.rows().front().lift_m == lift_before_m) {
                break;
            }
        }
        timed(us.fingers_us, [&] {
            pose_thumb(
                {k_at_once_s, surroundings_, tracking_, surface_, fingers_, traces_, fit_scratch_},
                tuning, stats_, variant.order);
        });
    }

    const GripSurface& surface() const { return surface_.rows().front(); }
    const Pose& wrist() const { return palm_.rows().front().pose_ws; }
    const FingerPose& fingers() const { return fingers_.rows().front(); }
    const PalmOffset& offset() const { return offset_.rows().front(); }
    const std::array<FingerTrace, k_finger_count>& traces() const { return traces_.front(); }

  private:
    void constrain(const Tuning& tuning, const GripVariant& variant) {
        constrain_palms({k_at_once_s, surroundings_, surface_, offset_, palm_}, tuning);
        if (!variant.sync) {
            const Pose tracked = surroundings_.front().wrist_bs;
            offset_.rows().front() = {};
            palm_.rows().front().pose_ws = tracked;
        }
    }

    EntityPool entities_;
    Column<HandTracking> tracking_;
    Column<GripSurface> surface_;
    Column<PalmOffset> offset_;
    Column<PalmPose> palm_;
    Column<FingerPose> fingers_;
    std::vector<HandSurroundings> surroundings_;
    std::vector<std::array<FingerTrace, k_finger_count>> traces_{1};
    GripSearchScratch search_scratch_;
    ChainFitScratch fit_scratch_;
    StageStats stats_;
};

}  // namespace

PosedHand pose_cold_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                         const Tuning& tuning, const GripVariant& variant) {
    OneHand hand(mesh, rig, wrist);
    PosedHand posed;
    hand.run(tuning, variant, posed.us);
    posed.gripped = hand.surface().triangle != GripSurface::k_none;
    posed.reason = posed.gripped ? "" : "no_surface";
    posed.wrist = hand.wrist();
    posed.sync_m = hand.offset().shown_m.norm();
    posed.sync_rad = hand.offset().shown_turn_rad.norm();
    if (posed.gripped) {
        posed.point = hand.surface().point_bs;
        posed.normal = hand.surface().normal_bs;
        posed.triangle = mesh.search.source_triangle[hand.surface().triangle];
        constexpr double k_anywhere_m = 1.0;
        if (const auto near = mesh.contact_bvh.closest_point(posed.point, k_anywhere_m)) {
            posed.triangle = mesh.contact.source_triangle[near->triangle];
        }
    }
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        posed.angles[f] = hand.fingers().shown[f];
        posed.traces[f] = hand.traces()[f];
    }
    return posed;
}

}  // namespace handhold::lab
