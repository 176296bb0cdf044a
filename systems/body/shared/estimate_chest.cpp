#include "systems/body/shared/estimate_chest.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/body_constants.hpp"
#include "systems/body/shared/lie_down.hpp"

namespace handhold {
namespace {

using ChestInputs = SideInputs<body_constants::k_chest_inputs>;
using ChestAnswer = NetworkAnswer<body_constants::k_chest_outputs>;

// Inputs that are the same for both sides.
struct ChestView {
    BodyView axes;
    std::array<Vec3, k_hand_count> hand;  // offset from the eyes in arm lengths
    std::array<double, k_hand_count> distance;
    // Sines of the angles to the unfiltered look direction: from the facing, then from the filtered
    // looks.
    std::array<double, k_look_filters> turned;
};

// The order of the network's inputs is that of tools/lab/bodies/estimator.py.
ChestInputs chest_inputs(const ChestView& view, HandSide side) {
    const std::size_t own = index_of(side);
    const std::size_t other = 1 - own;
    ChestInputs inputs(side);
    inputs.add(view.hand[own]);
    inputs.add(view.hand[other]);
    inputs.add(view.axes.fingers[own]);
    inputs.add(view.axes.back[own]);
    inputs.add(view.axes.fingers[other]);
    inputs.add(view.axes.back[other]);
    inputs.add(view.axes.head_up);
    inputs.add(view.axes.head_ahead);
    for (const double turned : view.turned) {
        inputs.add_lateral(turned);
    }
    inputs.add(view.distance[own]);
    inputs.add(view.distance[other]);
    return inputs;
}

// The line between the hands tells where the chest faces, but not if they are crossed. Distance of
// the right hand to the right of the left one, in arm lengths, between which the line counts from
// not at all to fully.
constexpr double k_line_fades = -0.05;
constexpr double k_line_full = 0.25;

}  // namespace

TrunkView trunk_view(const TrackedBody& body, const BodyAxes& axes) {
    const Vec3 up = axes.head.col(1);
    const Vec3 ahead = -axes.head.col(2);
    const double scale = body.measures.eye_height_m / k_scale_eye_m;
    const double eyes_m = (body.head_ps.position.y() - body.floor_m) / scale;
    TrunkView view{body.head_ps.position, up, lying_share(eyes_m, up, ahead)};
    const double sine_pitch = ahead.y();
    if (sine_pitch <= 0.0) {
        return view;
    }
    using namespace body_constants;
    const double level = std::sqrt(std::max(0.0, 1.0 - sine_pitch * sine_pitch));
    const double pitch = arc_tangent2(sine_pitch, level);
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos((1.0 - view.lying) * pitch * pitch / (pitch + k_nod_rad), sine, cosine);
    view.up_ps = cosine * up + sine * ahead;
    const Vec3 ahead_then = cosine * ahead - sine * up;
    view.eyes_ps +=
        scale * (k_ears_below_m * (view.up_ps - up) + k_ears_behind_m * (ahead_then - ahead));
    return view;
}

Quat chest_lean(const Vec3& up_ps, double lying) {
    constexpr double k_upright = 1.0 - body_constants::k_lean;
    const double upright = (1.0 - lying) * k_upright;
    const Vec3 up = upright * Vec3::UnitY() + (1.0 - upright) * up_ps;
    const double length = up.norm();
    return length > 0.1 ? rotation_between(Vec3::UnitY(), up / length) : Quat::Identity();
}

Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps, const TrackedBody& body,
                  const BodyAxes& axes, const TurnLimit& limit) {
    using namespace body_constants;
    // Positions of the hands in arm lengths. Axes: those of the leaning chest, turned to the look
    // direction (x right, z back).
    const Mat3 lean = lean_ps.toRotationMatrix();
    const double by_arm = 1.0 / arm_length_m(body.measures);
    std::array<Vec3, k_hand_count> hand;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const Vec3 from_eye = (body.hands_ps[side].position - body.head_ps.position) * by_arm;
        hand[side] = to_facing(look_ps, lean.transpose() * from_eye);
    }
    const Vec3 line = hand[1] - hand[0];
    const double rolled = lean.col(1).dot(axes.hands[1].col(1) - axes.hands[0].col(1));
    const double apart = smooth_step(line.x(), k_line_fades, k_line_full);
    const double right = k_hand_share * (hand[0].x() + hand[1].x()) +
                         k_line_share * apart * line.z() + k_roll_share * rolled;
    const double ahead =
        1.0 - k_hand_share * (hand[0].z() + hand[1].z()) + k_line_share * std::max(line.x(), 0.0);
    const double length = std::sqrt(right * right + ahead * ahead);
    double sine = length > 0.0 ? -right / length : 0.0;
    double cosine = length > 0.0 ? ahead / length : 1.0;
    if (cosine < limit.cosine) {
        cosine = limit.cosine;
        sine = std::copysign(limit.sine, sine);
    }
    return turned_left(look_ps, cosine, sine);
}

ChestCorrection chest_correction(const Vec3& facing_ps, const Vec3& look_ps,
                                 const std::array<Vec3, k_look_filters>& looks_ps,
                                 const TrackedBody& body, const BodyAxes& axes) {
    ChestView view{view_from(facing_ps, axes), {}, {}, {}};
    const double by_arm = 1.0 / arm_length_m(body.measures);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        view.hand[side] =
            to_facing(facing_ps, (body.hands_ps[side].position - body.head_ps.position) * by_arm);
        view.distance[side] = view.hand[side].norm();
    }
    view.turned[0] = sine_between(facing_ps, look_ps);
    for (std::size_t i = 1; i < k_look_filters; ++i) {
        view.turned[i] = sine_between(looks_ps[i], look_ps);
    }
    const ChestAnswer left =
        evaluate(body_constants::k_chest_network, chest_inputs(view, HandSide::left).values());
    const ChestAnswer right =
        evaluate(body_constants::k_chest_network, chest_inputs(view, HandSide::right).values());
    const double half = 0.5 * std::min(left.familiarity, right.familiarity);
    const auto lateral = [&](std::size_t i) {
        return half * (static_cast<double>(right.values[i]) - static_cast<double>(left.values[i]));
    };
    const auto common = [&](std::size_t i) {
        return half * (static_cast<double>(right.values[i]) + static_cast<double>(left.values[i]));
    };
    return {lateral(0), {Vec3(lateral(1), common(2), common(3)), lateral(4)}};
}

Pose chest_pose(const Vec3& facing_ps, const Quat& lean_ps, const ChestOffset& offset,
                const TrackedBody& body, const TrunkView& trunk) {
    using namespace body_constants;
    const Quat level = product(lean_ps, level_rotation(facing_ps));
    const double scale = body.measures.eye_height_m / k_scale_eye_m;
    const Vec3 from_neck = Vec3(0.0, k_shoulders_up_m, k_shoulders_back_m) + offset.middle_m;
    const double roll = offset.roll;
    // tan(a / 2) = tan a / (1 + sqrt(1 + tan^2 a))
    const Quat rolled =
        product(level, unit_quat(1.0 + std::sqrt(1.0 + roll * roll), 0.0, 0.0, roll));
    Pose chest{
        trunk.eyes_ps + scale * (level.toRotationMatrix() * from_neck - k_neck_m * trunk.up_ps),
        rolled};
    if (trunk.lying > 0.0) {
        constexpr double k_shoulder_m = 0.05;  // half the thickness of an arm
        const double half_m = 0.5 * body.measures.shoulder_width_m;
        const double lowest_m = chest.position.y() - body.floor_m -
                                half_m * std::abs((chest.rotation * Vec3::UnitX()).y());
        chest.position.y() += trunk.lying * std::max(0.0, scale * k_shoulder_m - lowest_m);
    }
    return chest;
}

Vec3 neck_pivot(const TrackedBody& body, const BodyAxes& axes) {
    using namespace body_constants;
    const double scale = body.measures.eye_height_m / k_scale_eye_m;
    const Vec3 ears(0.0, -k_ears_below_m, k_ears_behind_m);
    const Vec3 base(0.0, -k_neck_m, k_shoulders_back_m);
    return body.head_ps.position + (0.5 * scale) * (axes.head * (ears + base));
}

}  // namespace handhold
