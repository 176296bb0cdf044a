#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Hand rigs. Hand space (_hs) is the wrist's frame with OpenXR's axes, in metres: -Z points to the
// fingers, +Y out of the back of the hand. A rig is an asset: it is built once and does not change
// while frames run.
namespace handhold {

inline constexpr std::size_t k_max_links = 3;

// Joint angles of one finger.
struct FingerAngles {
    std::array<double, k_max_links> curl_rad = {};
    double opposition_rad = 0.0;
};

// One finger: a chain of hinges in one plane, the finger's disc. Link i runs from hinge i to hinge
// i + 1, the last link to the tip. A hinge's frame has -Z along its link and +X along the hinge; a
// positive curl turns the link from -Z towards -Y, the palm's side.
struct FingerRig {
    FingerName name = FingerName::index;
    std::uint32_t link_count = 3;  // 2 or 3
    Pose base_hs;                  // frame of the first hinge at curl 0 and opposition 0
    std::array<double, k_max_links> length_m = {};
    std::array<double, k_max_links> radius_m = {};   // radius of the link's capsule
    std::array<double, k_max_links> lower_rad = {};  // minimum curl: fully open
    // Maximum curl: fully closed. A closing finger moves all hinges from lower_rad to upper_rad
    // together.
    std::array<double, k_max_links> upper_rad = {};
    std::array<double, k_max_links> rest_rad = {};  // curl in the rest pose
    FingerAngles fist;                              // pose in a fist, within the limits
    // Unit axis through the first hinge. The opposition angle turns the digit's disc about it: a
    // thumb's opposition, a finger's spread. A range of 0 fixes the disc.
    Vec3 opposition_axis_hs = -Vec3::UnitZ();
    double lower_opposition_rad = 0.0;
    double upper_opposition_rad = 0.0;
};

inline constexpr std::size_t k_max_palm_capsules = 12;

// A capsule of the palm, such as a metacarpal, the heel or the ball of the thumb.
struct PalmCapsule {
    Vec3 a_hs = Vec3::Zero();
    Vec3 b_hs = Vec3::Zero();
    double radius_m = 0.0;
};

// A skinning joint, rigidly attached to one link or to the palm: joint = link frame *
// joint_in_link.
struct RigJoint {
    static constexpr std::int32_t k_palm = -1;
    std::string name;          // WebXR name: "wrist", "index-finger-phalanx-proximal", ...
    std::int32_t finger = -1;  // index into HandRig::fingers, or k_palm
    std::uint32_t link = 0;    // link of that finger
    Pose joint_in_link;        // pose in the link's hinge frame, or in hand space for the palm
};

struct HandRig {
    HandSide side = HandSide::right;
    std::vector<FingerRig> fingers;                  // 2 to 5 fingers, each name at most once
    std::vector<PalmCapsule> palm;                   // k_max_palm_capsules at most
    Vec3 palm_center_hs = Vec3(0.0, -0.014, -0.08);  // point on the palm's skin
    Vec3 palm_normal_hs = -Vec3::UnitY();            // unit, out of the palm
    std::vector<RigJoint> joints;                    // empty: no skin
};

// A hand that has its own rig: index into FrameCaches::more_hand_rigs. A hand without this
// component, or with an index beyond the list, has the rig of its side. Written by the host.
struct HandRigChoice {
    std::uint32_t index = 0;
};

}  // namespace handhold
