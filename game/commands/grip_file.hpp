#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/io/gltf_writer.hpp"
#include "engine/io/result.hpp"
#include "game/scene/scene_grip.hpp"

// Authored grips through an animation package: a .glb of hand, controller and thing together. Talk
// rows 9 and 10.
namespace handhold {

// Nodes of the file: "grip/<name>/right" (or "left") with the hand's skeleton, joints by WebXR's
// names; "object" with what is held; "controller", empty, where the controller is that the hand
// belongs to. Whoever poses moves and turns joints, or hand and object as a whole.
struct GripScene {
    SceneGrip grip;  // of the side's hand only the wrist counts, and which fingers are posed
    HandSide side = HandSide::right;
    std::array<FingerAngles, k_finger_count> fingers;  // as shown, by place in the rig's fingers
    Pose controller_in_hand;
    std::vector<GltfMaterial> materials;
    std::vector<GltfSurface> object;  // in the frame of the grip
};
// The bytes of a .glb; the hand is the robot's over the rig, of the side's.
std::string write_grip_glb(const GripScene& scene, const HandRig& rig);

// The grip that a file's hand is in, as it stands: the wrist against the node "object", angles of
// the joints as hinges of the rig of its side, held to its limits. Priority, zone, mirror and which
// fingers close by themselves are numbers in the extras of the wrist's node; of a file without them
// the defaults, and all fingers posed. Refused, with the JSON pointer: no node "object", no or two
// hands, a missing joint, numbers that no grip has.
Result<SceneGrip> parse_grip_glb(std::string_view bytes, const std::filesystem::path& path,
                                 const std::array<HandRig, k_hand_count>& rigs);

}  // namespace handhold
