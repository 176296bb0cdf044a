#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "game/commands/exported_objects.hpp"
#include "game/scene/scene_grip.hpp"

// Authored grips for animation software: a .glb of hand, controller and object. Talk rows 9 and 10.
namespace handhold {

// The content of the file. Its nodes:
// - "grip/<name>/right" (or "left"): the hand's skeleton, with WebXR's joint names
// - "object": the held object
// - "controller": an empty node at the pose of that hand's controller; nodes
//   "controller-part-0" and so on have its model
// Authors move and turn joints, or the hand and the object as a whole.
struct GripScene {
    SceneGrip
        grip;  // the grip; of its hands only that of `side` is used, with `fingers` as shown pose
    HandSide side = HandSide::right;
    std::array<FingerAngles, k_finger_count> fingers;  // shown pose, by index in HandRig::fingers
    std::vector<GltfMaterial> materials;
    std::vector<GltfSurface> object;     // surfaces of the held object, in the frame of wrist_bs
    std::vector<GltfObject> controller;  // poses in hand space; first the node "controller"
};
// Returns the bytes of a .glb file. Its hand is the mesh of the game's robot, built for `rig`.
std::string write_grip_glb(const GripScene& scene, const HandRig& rig);

// Reads the grip: the wrist relative to the node "object", and the joints' rotations as hinge
// angles of the rig, clamped to its limits. Extras of the wrist's node hold the priority, the snap
// radius and angle, the mirror axis, the set of posed fingers, and the pressed angles of fingers
// that follow the trigger. Missing extras get default values; by default all fingers are posed.
// Fails, with the JSON pointer of the place, if there is not exactly one hand and one node
// "object", if a joint is missing, or if a value is out of range.
Result<SceneGrip> parse_grip_glb(std::string_view bytes, const std::filesystem::path& path,
                                 const std::array<HandRig, k_hand_count>& rigs);

}  // namespace handhold
