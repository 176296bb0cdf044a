#include "components/hand_rig.hpp"

namespace handhold {

std::array<Pose, k_most_links> finger_link_frames(const FingerRig& finger,
                                                  const FingerAngles& angles) {
    std::array<Pose, k_most_links> frames;
    Pose at = finger.base_hs;
    at.rotation = rotation_about(finger.opposition_axis_hs, angles.opposition_rad) * at.rotation;
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        at.rotation = at.rotation * rotation_about(-Vec3::UnitX(), angles.curl_rad[link]);
        frames[link] = at;
        at.position = transform_point(at, Vec3(0.0, 0.0, -finger.length_m[link]));
    }
    return frames;
}

}  // namespace handhold
