#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_bones.hpp"
#include "systems/rigs/body_rig.hpp"
#include "systems/rigs/hand_joint_names.hpp"

// Finds the fingers of a figure's hands.
namespace handhold {

// A joint at which a finger bends, and the bone of the hand that it begins.
struct FigureHinge {
    std::size_t joint = 0;
    HandBone bone = HandBone::proximal;
};
struct FigureFinger {
    FingerName name = FingerName::index;
    std::vector<FigureHinge> hinges;  // 1 to 3
    std::optional<std::size_t> tip;
};

// Finds the fingers below a figure's forearm, in the order of FingerName: by the map, then by the
// joints' names (parse_finger_joint_name) and their hierarchy. Metacarpals of fingers belong to the
// palm; a thumb's is its first hinge. Joints beyond the third hinge are the tip and what follows
// it. Leaves out fingers whose last bone has no direction: one joint and no tip.
std::vector<FigureFinger> find_figure_fingers(const SkinnedMesh& figure, const BodyBones& bones,
                                              HandSide side);

// Axes of hand space of a figure's hand in the file's frame, from wrist and knuckles; none without
// two fingers.
std::optional<Quat> figure_hand_axes(const SkinnedMesh& figure, std::size_t hand,
                                     const std::vector<FigureFinger>& fingers, HandSide side);

// Carriers of a finger's bones, in order; hinges[i] is followed by element i. `hand_ms`: hand space
// in the file's frame. `first`: the index that the first of them will have in BodyRig::carriers;
// `hand`: the index of the hand's carrier.
std::vector<BodyRig::Carrier> finger_carriers(const SkinnedMesh& figure, const FigureFinger& finger,
                                              const Pose& hand_ms, HandSide side, std::size_t first,
                                              std::size_t hand);

}  // namespace handhold
