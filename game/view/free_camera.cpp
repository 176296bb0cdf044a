#include "game/view/free_camera.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr double k_fly_mps = 1.5;
constexpr double k_camera_hurry = 4.0;  // factor on the speed while hurrying
constexpr double k_camera_turn_radps = 1.5;
constexpr double k_camera_snap_rad = 30.0 * k_degree;
constexpr double k_camera_steepest_rad = 85.0 * k_degree;

// Pitch of the view above level.
double pitch_of(const Pose& camera_ws, const Vec3& up_ws) {
    const double sine = (camera_ws.rotation * -Vec3::UnitZ()).dot(up_ws);
    return std::asin(std::clamp(sine, -1.0, 1.0));
}

}  // namespace

void FreeCamera::begin(const Pose& camera_ws, const Vec3& up_ws, const DesktopInput& input) {
    up_ws_ = up_ws;
    grip_ = input.grip;
    pose_ws_ = {camera_ws.position, look_rotation(camera_ws.rotation * -Vec3::UnitZ(), up_ws)};
}

void FreeCamera::fly(const DesktopInput& input, double dt_s) {
    const double left_rad = input.turn_left_rad + k_camera_turn_radps * input.smooth_turn * dt_s +
                            k_camera_snap_rad * input.snap_turns;
    const double pitch = pitch_of(pose_ws_, up_ws_);
    const double raised_rad =
        std::clamp(pitch + input.look_up_rad, std::min(pitch, -k_camera_steepest_rad),
                   std::max(pitch, k_camera_steepest_rad)) -
        pitch;
    pose_ws_.rotation = (rotation_about(up_ws_, left_rad) * pose_ws_.rotation *
                         rotation_about(Vec3::UnitX(), raised_rad))
                            .normalized();
    const double speed_mps = input.hurry ? k_camera_hurry * k_fly_mps : k_fly_mps;
    pose_ws_.position +=
        pose_ws_.rotation * (speed_mps * dt_s * Vec3(input.move.x, input.move.y, input.move.z));
}

DesktopInput FreeCamera::held() const {
    DesktopInput input;
    input.grip = grip_;
    return input;
}

}  // namespace handhold
