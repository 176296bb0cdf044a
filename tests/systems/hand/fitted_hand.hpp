#pragma once

#include <limits>

#include "engine/geometry/grip_mesh.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/sweep_fingers.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::test {

// Frame length that lifts all rate limits.
constexpr double k_unlimited_s = std::numeric_limits<double>::infinity();

// A floor in the plane y = 0 facing up, one metre wide, with cells of 25 mm.
inline Mesh make_floor_mesh() {
    constexpr std::uint32_t k_cells = 40;
    Mesh mesh;
    for (std::uint32_t z = 0; z <= k_cells; ++z) {
        for (std::uint32_t x = 0; x <= k_cells; ++x) {
            mesh.positions.emplace_back(0.025 * x - 0.5, 0.0, 0.025 * z - 0.5);
        }
    }
    for (std::uint32_t z = 0; z < k_cells; ++z) {
        for (std::uint32_t x = 0; x < k_cells; ++x) {
            const std::uint32_t corner = z * (k_cells + 1) + x;
            mesh.triangles.push_back({corner, corner + k_cells + 1, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + k_cells + 1, corner + k_cells + 2});
        }
    }
    return mesh;
}

// The same floor with a wall at z = -`to_wall_m`, which faces +z.
inline Mesh make_corner_mesh(double to_wall_m) {
    const Mesh floor = make_floor_mesh();
    Mesh mesh = floor;
    const auto first = static_cast<std::uint32_t>(floor.positions.size());
    for (const Vec3& p : floor.positions) {
        mesh.positions.emplace_back(p.x(), 0.48 - p.z(), -to_wall_m);
    }
    for (const auto& [a, b, c] : floor.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
    return mesh;
}

// The columns of one hand that grips one mesh, and the four stages that fit it.
struct FittedHand {
    const HandRig rig;
    Tuning tuning;
    StageStats stats;
    Column<HandTracking> tracking;
    Column<GripSurface> surface;
    Column<PalmOffset> offset;
    Column<PalmPose> palm;
    Column<FingerPose> fingers;
    std::vector<HandSurroundings> hands;
    std::vector<std::array<FingerTrace, k_finger_count>> traces{1};
    GripSearchScratch search_scratch;
    ChainFitScratch fit_scratch;

    FittedHand(const GripMesh& mesh, const Pose& wrist_bs, HandSide side = HandSide::right)
        : rig(builtin_hand_rig(side)) {
        tracking.add(k_right).pressed = true;
        surface.add(k_right);
        offset.add(k_right);
        palm.add(k_right);
        fingers.add(k_right);
        hands.push_back({.hand = k_right,
                         .body = k_wall,
                         .rig = &rig,
                         .body_ws = {},
                         .wrist_bs = wrist_bs,
                         .meshes = {{&mesh, {}}},
                         .signature = 1,
                         .search_signature = 1,
                         .is_gripping = true});
    }
    FittedHand(const FittedHand&) = delete;
    FittedHand& operator=(const FittedHand&) = delete;

    void search() {
        search_grip({.hands = hands, .surface = surface, .scratch = search_scratch}, tuning, stats);
    }
    // Shows the palm where it is held, until fit() shows the fitted one.
    void constrain() {
        constrain_palms({.hands = hands, .surface = surface, .offset = offset});
        palm.at(k_right).pose_ws =
            hands.front().body_ws * held_wrist_bs(hands.front(), offset.at(k_right));
    }
    void sweep() {
        sweep_fingers({.hands = hands,
                       .surface = surface,
                       .offset = offset,
                       .fingers = fingers,
                       .traces = traces,
                       .scratch = fit_scratch},
                      tuning, stats);
    }
    void fit(double dt_s) {
        fit_hands({.dt_s = dt_s,
                   .hands = hands,
                   .hand = tracking,
                   .surface = surface,
                   .offset = offset,
                   .fingers = fingers,
                   .palm = palm},
                  tuning, stats);
    }
    void frame(double dt_s) {
        search();
        constrain();
        sweep();
        fit(dt_s);
    }

    Pose& wrist_bs() { return hands.front().wrist_bs; }
    Pose shown_bs() { return inverse(hands.front().body_ws) * palm.at(k_right).pose_ws; }
    Vec3 palm_center_bs() { return transform_point(shown_bs(), rig.palm_center_hs); }
    Vec3 palm_up_bs() { return shown_bs().rotation * -rig.palm_normal_hs; }
    const FingerPose& pose() { return fingers.at(k_right); }
};

// Calls visit(end, radius_m) for the ends of the axes of the shown hand's capsules, in the frame
// of `wrist`.
template <typename Visit>
void visit_axis_ends(const FittedHand& hand, const Pose& wrist, const Visit& visit) {
    for (const PalmCapsule& capsule : hand.rig.palm) {
        visit(transform_point(wrist, capsule.a_hs), capsule.radius_m);
        visit(transform_point(wrist, capsule.b_hs), capsule.radius_m);
    }
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        const auto points_hs = finger_points(finger, hand.fingers.at(k_right).shown[f]);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            visit(transform_point(wrist, points_hs[i + 1]), finger.radius_m[i]);
        }
    }
}

// The wrist that puts the palm's centre at `center` with the back of the hand along `up` and the
// fingers as close to -Z as possible.
inline Pose wrist_with_palm_at(const HandRig& rig, const Vec3& center, const Vec3& up) {
    const Quat rotation = rotation_between(Vec3::UnitY(), up);
    return {center - rotation * rig.palm_center_hs, rotation};
}

}  // namespace handhold::test
