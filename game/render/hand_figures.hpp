#pragma once

#include <array>
#include <optional>
#include <vector>

#include "components/render.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/render/renderer.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

// Hands as they are drawn: the robot's, rigid part by part, or a loaded skin.
namespace handhold {

// One side's hand. Without a skin it is the robot's over the rig.
struct HandModel {
    HandRig rig;
    std::optional<SkinnedMesh> skin;
    HandRigFit fit;  // of the skin
};
using HandModels = std::array<HandModel, k_hand_count>;

HandModels builtin_hand_models();
// Skins of both sides with WebXR's joint names.
Result<HandModels> load_hand_models(const std::filesystem::path& left,
                                    const std::filesystem::path& right);

// Of a command line's files: none, or left and right.
Result<HandModels> choose_hand_models(std::span<const std::string> files);

// How every joint of a skin stands in hand space with these fingers, by RigJoint.
std::vector<Pose> skeleton_pose(const HandRig& rig,
                                const std::array<FingerAngles, k_finger_count>& fingers);

// The meshes of both hands in one renderer. Every hand of a picture is added anew for each
// picture.
class HandFigures {
  public:
    HandFigures(HandModels models, Renderer& renderer);

    void begin();  // a new picture
    void add(HandSide side, const Pose& wrist_ws,
             const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
             RenderFrame& frame);

    const HandRig& rig(HandSide side) const { return models_[index_of(side)].rig; }

  private:
    // A part of the robot's hand that is on the graphics card.
    struct Part {
        std::int32_t finger = RigJoint::k_palm;
        std::uint32_t link = 0;
        MeshId mesh{};
        Look look;
    };
    // A skin bends: every hand of a picture has its own copies, one for each colour.
    using SkinCopy = std::vector<MeshId>;

    void add_parts(HandSide side, const Pose& wrist_ws,
                   const std::array<FingerAngles, k_finger_count>& fingers,
                   RenderFrame& frame) const;
    void add_skin(HandSide side, const Pose& wrist_ws,
                  const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
                  RenderFrame& frame);

    HandModels models_;
    std::array<std::vector<Part>, k_hand_count> parts_;
    std::array<std::vector<SkinCopy>, k_hand_count> copies_;
    std::array<std::size_t, k_hand_count> used_ = {};  // copies in this picture
    std::vector<Vec3> positions_, normals_;            // scratch
};

}  // namespace handhold
