#include "systems/body/shared/pose_spine.hpp"

#include <algorithm>
#include <optional>

#include "engine/anim/deflect_outward.hpp"
#include "systems/body/shared/hang_body.hpp"
#include "systems/body/shared/spine_chain.hpp"

namespace handhold {
namespace {

// The chain's positions relative to the chest, in world axes.
struct PlacedChain {
    SpineChain frames;
    BodyLinkVectors base_m;   // upper ends of the links
    BodyLinkVectors end_m;    // lower ends of the links
    BodyLinkVectors towards;  // unit directions of the links in their parents' frames
};

// Computes the hanging chain: interpolates between the last two ticks and restores the lengths of
// the bones.
void hang(const SpineMemory& memory, const Mat3& to_ws, double scale, PlacedChain& out) {
    const double share = memory.since_tick_s / k_spine_tick_s;
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& above = frame_above_link(out.frames, link);
        const Vec3 base = link_base(above, out.end_m, link, scale);
        const Vec3 end =
            to_ws * (memory.before_m[i] + share * (memory.offset_m[i] - memory.before_m[i]));
        Vec3 towards = above.axes.transpose() * (end - base);
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards * (1.0 / distance)) : link.rest;
        out.towards[i] = towards;
        out.base_m[i] = base;
        out.end_m[i] = base + above.axes * ((scale * link.length_m) * towards);
        out.frames.links[i] =
            frame_at(link_frame(above.rotation, towards, link_twist_rad(memory, i)));
    }
}

// Folds a hanging chain above the tracked floor, from the top down.
class BodyFolder {
  public:
    // `up_ws`: the floor's normal.
    BodyFolder(const SpineMemory& memory, const TrackedFloor& floor, const Vec3& up_ws,
               PlacedChain& chain)
        : memory_(memory), floor_(floor), up_ws_(up_ws), chain_(chain) {}

    // Folds the chain. Returns the turns of the toes (LegFold::toes_rad), by HandSide.
    std::array<double, k_hand_count> fold() {
        const TrunkFold trunk =
            fold_trunk(floor_.chest_m / floor_.scale, in_frame(chain_.frames.chest));
        const double bent = 1.0 - floor_.lying;  // a body that lies is not folded
        const double lean_rad = bent * trunk.lean_rad;
        if (lean_rad != 0.0 || floor_.lying > 0.0) {
            const double clearance_m =
                bent * k_pelvis_clearance_m + floor_.lying * k_lying_clearance_m;
            for (std::size_t i = 0; i < k_spine_links; ++i) {
                place(i, -bent * trunk.bend_rad[i], clearance_m);
            }
        }
        std::array<double, k_hand_count> toes_rad{};
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            toes_rad[side] = bent * fold_leg(k_spine_links + 2 * side, lean_rad);
        }
        return toes_rad;
    }

  private:
    Vec3 in_frame(const SpineFrame& frame) const { return frame.axes.transpose() * up_ws_; }
    double height_m(const Vec3& from_chest_m) const {
        return (floor_.chest_m + up_ws_.dot(from_chest_m)) / floor_.scale;
    }

    // Folds one leg. If the ankle ends below its clearance, because the leg swings, folds again as
    // if the pelvis were lower by the missing height.
    double fold_leg(std::size_t thigh, double lean_rad) {
        constexpr int k_corrections = 6;
        const SpineFrame& pelvis = chain_.frames.links[k_spine_links - 1];
        const double pelvis_m = height_m(chain_.end_m[k_spine_links - 1]);
        double lower_m = 0.0;
        double knee_clearance_m = k_knee_clearance_m;
        LegFold fold;
        for (int i = 0; i < k_corrections; ++i) {
            fold = fold_legs(pelvis_m - lower_m, in_frame(pelvis), lean_rad);
            if (fold.thigh_rad == 0.0 && fold.knee_rad == 0.0 && lean_rad == 0.0 &&
                floor_.lying == 0.0) {
                return 0.0;
            }
            const double bent = 1.0 - floor_.lying;
            place(thigh, bent * fold.thigh_rad, knee_clearance_m);
            const Vec3& shin = chain_.towards[thigh + 1];
            const double knee_rad = arc_tangent2(shin.z(), -shin.y());
            place(thigh + 1, -std::min(bent * fold.knee_rad, k_knee_max_rad - knee_rad),
                  floor_.lying > 0.0 ? std::optional(k_lying_clearance_m * floor_.lying)
                                     : std::nullopt);
            const double missing_m = k_ankle_clearance_m - height_m(chain_.end_m[thigh + 1]);
            if (!(missing_m > 0.0)) {
                break;
            }
            lower_m += missing_m;
            // In the last corrections the knee cannot fold further: lifts the thigh.
            if (i + 3 >= k_corrections) {
                knee_clearance_m = height_m(chain_.end_m[thigh]) + missing_m;
            }
        }
        return fold.toes_rad;
    }

    // Places a link after turning its parent's frame about X. With a clearance, raises the link
    // until its lower end is at least that high above the floor.
    void place(std::size_t i, double turn_rad, std::optional<double> clearance_m) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& parent = frame_above_link(chain_.frames, link);
        const double length_m = floor_.scale * link.length_m;
        const Vec3 base = link_base(parent, chain_.end_m, link, floor_.scale);
        const SpineFrame above =
            frame_at((parent.rotation * rotation_about(Vec3::UnitX(), turn_rad)).normalized());
        Vec3 towards = chain_.towards[i];
        if (clearance_m) {
            const double least_m = floor_.scale * (*clearance_m - height_m(base));
            towards = deflect_outward(towards, in_frame(above), least_m / length_m, 2.0);
        }
        chain_.base_m[i] = base;
        chain_.end_m[i] = base + above.axes * (length_m * towards);
        chain_.frames.links[i] =
            frame_at(link_frame(above.rotation, towards, link_twist_rad(memory_, i)));
    }

    const SpineMemory& memory_;
    TrackedFloor floor_;
    Vec3 up_ws_;
    PlacedChain& chain_;
};

}  // namespace

void pose_spine(const Pose& chest_ws, const SpineMemory& memory, const Pose& chest_ps,
                const TrackedFloor& floor, SpinePose& out) {
    // Rotation from play-space axes to world axes.
    const Mat3 to_ws =
        chest_ws.rotation.toRotationMatrix() * chest_ps.rotation.toRotationMatrix().transpose();
    const double share = memory.since_tick_s / k_spine_tick_s;
    const Vec3 pull_ps = memory.pull.before + share * (memory.pull.now - memory.pull.before);
    const Quat to_chest = chest_ps.rotation.conjugate();
    const Quat leaning = leaning_chest(
        chest_ws.rotation,
        lean_of(to_chest * pull_ps, upright_turn(to_chest * Vec3::UnitY(), floor.lying)));
    PlacedChain chain{{frame_at(leaning), {}}, {}, {}, {}};
    hang(memory, to_ws, floor.scale, chain);
    const std::array<double, k_hand_count> toes_rad =
        BodyFolder(memory, floor, to_ws * Vec3::UnitY(), chain).fold();
    const auto pose_at = [&](std::size_t i) {
        return Pose{chest_ws.position + chain.base_m[i], chain.frames.links[i].rotation};
    };
    const auto end_of = [&](std::size_t i) { return Vec3(chest_ws.position + chain.end_m[i]); };
    out.chest_ws = {chest_ws.position, leaning};
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        out.spine_ws[i] = pose_at(i);
    }
    out.pelvis_ws = {end_of(k_spine_links - 1), chain.frames.links[k_spine_links - 1].rotation};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const std::size_t thigh = k_spine_links + 2 * side;
        const Quat toes = rotation_about(Vec3::UnitX(), k_toes_rest_rad + toes_rad[side]);
        SpinePose::Leg& leg = out.legs[side];
        leg.thigh_ws = pose_at(thigh);
        leg.shin_ws = pose_at(thigh + 1);
        leg.foot_ws = {end_of(thigh + 1), product(chain.frames.links[thigh + 1].rotation, toes)};
    }
}

}  // namespace handhold
