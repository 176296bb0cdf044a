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

// Authored grips in an animation package: a .glb of hand, controller and object. Talk rows 9 and
// 10.
namespace handhold {

// Nodes: "grip/<name>/right" (or "left") with the hand's skeleton, joints by WebXR's names;
// "object", the held object; "controller", an empty node for the controller of that hand. Authors
// move and turn joints, or the hand and the object as a whole.
struct GripScene {
    SceneGrip grip;  // for this side only the wrist and which fingers are posed count
    HandSide side = HandSide::right;
    std::array<FingerAngles, k_finger_count>
        fingers;  // as shown, in the order of the rig's fingers
    Pose controller_in_hand;
    std::vector<GltfMaterial> materials;
    std::vector<GltfSurface> object;  // in the frame of the grip
};
// The bytes of a .glb with the robot's hand over the rig.
std::string write_grip_glb(const GripScene& scene, const HandRig& rig);

// The grip of a file's hand: the wrist relative to the node "object", and the joints' angles as
// hinges of the rig of that side, clamped to its limits. Priority, zone, mirror and which fingers
// close by themselves are extras of the wrist's node; without them, the defaults, and all fingers
// are posed. Refused, with the JSON pointer: no node "object", no hand or two, a missing joint,
// numbers that no grip has.
Result<SceneGrip> parse_grip_glb(std::string_view bytes, const std::filesystem::path& path,
                                 const std::array<HandRig, k_hand_count>& rigs);

}  // namespace handhold
