#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "engine/io/gltf_writer.hpp"
#include "game/scene/scene_grip.hpp"

// Authored grips for animation software: a .glb of hand, controller and object. Talk rows 9 and 10.
namespace handhold {

// The content of the file. Its nodes:
// - "grip/<name>/right" (or "left"): the hand's skeleton, with WebXR's joint names
// - "object": the held object
// - "controller": an empty node at the pose of that hand's controller
// Authors move and turn joints, or the hand and the object as a whole.
struct GripScene {
    SceneGrip
        grip;  // grip of this side's hand; only the wrist and the set of posed fingers are used
    HandSide side = HandSide::right;
    std::array<FingerAngles, k_finger_count> fingers;  // shown pose, by index in HandRig::fingers
    Pose controller_in_hand;
    std::vector<GltfMaterial> materials;
    std::vector<GltfSurface> object;  // surfaces in the frame of the grip
};
// Returns the bytes of a .glb file. Its hand is the mesh of the game's robot, built for `rig`.
std::string write_grip_glb(const GripScene& scene, const HandRig& rig);

// Reads the grip: the wrist relative to the node "object", and the joints' rotations as hinge
// angles of the rig, clamped to its limits. Extras of the wrist's node hold priority, zone, mirror
// and the set of posed fingers. Missing extras get default values: all fingers are posed. Errors
// name the JSON pointer: no node "object", no hand or several, a missing joint, or values out of
// range.
Result<SceneGrip> parse_grip_glb(std::string_view bytes, const std::filesystem::path& path,
                                 const std::array<HandRig, k_hand_count>& rigs);

}  // namespace handhold
