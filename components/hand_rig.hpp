#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Hands as data. Hand space (_hs) is the wrist's frame with OpenXR's axes: -Z to the fingers, +Y
// the back of the hand, metres. A rig is an asset: made once, never changed while frames run.
namespace handhold {

enum class FingerName : std::uint8_t { thumb, index, middle, ring, little };
inline constexpr std::size_t k_finger_count = 5;
inline constexpr std::size_t k_max_links = 3;

// One finger: a chain of hinges in one plane, the finger's disc. Link i begins at hinge i and ends
// at the next one, the last at the tip. A hinge's frame has -Z along its link, +X along the hinge;
// a positive curl turns the link from -Z towards -Y, which is the palm's side.
struct FingerRig {
    FingerName name = FingerName::index;
    std::uint32_t link_count = 3;  // 2 or 3
    Pose base_hs;                  // frame of the first hinge at curl 0
    std::array<double, k_max_links> length_m = {};
    std::array<double, k_max_links> radius_m = {};   // of the link's capsule
    std::array<double, k_max_links> lower_rad = {};  // fully open; curls are never less
    std::array<double, k_max_links> upper_rad = {};  // fully curled; a closing finger's hinges
                                                     // go from lower to upper together
    std::array<double, k_max_links> rest_rad = {};   // where nothing is touched
    // The thumb's plane turns about this unit axis through the first hinge by the opposition angle;
    // 0 for the other fingers, whose plane is fixed.
    Vec3 opposition_axis_hs = -Vec3::UnitZ();
    double lower_opposition_rad = 0.0;
    double upper_opposition_rad = 0.0;
};

// A capsule of the palm: a metacarpal, the heel, the ball of the thumb.
struct PalmCapsule {
    Vec3 a_hs = Vec3::Zero();
    Vec3 b_hs = Vec3::Zero();
    double radius_m = 0.0;
};

// A joint of the skeleton that a skin hangs on. It is carried by one link, or by the palm, as a
// rigid part: joint = link frame * joint_in_link.
struct RigJoint {
    static constexpr std::int32_t k_palm = -1;
    std::string name;          // WebXR's: "wrist", "index-finger-phalanx-proximal", ...
    std::int32_t finger = -1;  // into HandRig::fingers, or k_palm
    std::uint32_t link = 0;    // of the finger
    Pose joint_in_link;        // in the link's hinge frame, or in hand space for the palm
};

struct HandRig {
    HandSide side = HandSide::right;
    std::vector<FingerRig> fingers;  // 2 to 5, each name at most once
    std::vector<PalmCapsule> palm;
    Vec3 palm_center_hs = Vec3(0.0, -0.014, -0.08);  // on the skin
    Vec3 palm_normal_hs = -Vec3::UnitY();            // unit, out of the palm
    std::vector<RigJoint> joints;                    // empty where there is no skin
};

// How one hand's fingers stand, by place in HandRig::fingers.
struct FingerAngles {
    std::array<double, k_max_links> curl_rad = {};
    double opposition_rad = 0.0;
};

}  // namespace handhold
