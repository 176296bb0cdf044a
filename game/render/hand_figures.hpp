#pragma once

#include <array>
#include <optional>
#include <vector>

#include "components/render.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/render/renderer.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

// Draws hands: the robot's rigid parts, or a loaded skin.
namespace handhold {

// One side's hand. Without a skin, the robot's parts are built for the rig.
struct HandModel {
    HandRig rig;
    std::optional<SkinnedMesh> skin;
    HandRigFit fit;  // how the rig was fitted to the skin
};
using HandModels = std::array<HandModel, k_hand_count>;

HandModels builtin_hand_models();
// Loads the skins of both hands. Their joints must have WebXR's names.
Result<HandModels> load_hand_models(const std::filesystem::path& left,
                                    const std::filesystem::path& right);

// Hand models for the files on the command line: without files, the built-in ones; else files[0]
// left and files[1] right. Precondition: 0 or 2 files.
Result<HandModels> choose_hand_models(std::span<const std::string> files);

// Returns the poses in hand space of all joints of the rig's skin for these finger angles, indexed
// as HandRig::joints.
std::vector<Pose> skeleton_pose(const HandRig& rig,
                                const std::array<FingerAngles, k_finger_count>& fingers);

// The meshes of both hands in one renderer. For each picture, call begin(), then add() for every
// hand.
class HandFigures {
  public:
    HandFigures(HandModels models, Renderer& renderer);

    void begin();  // starts a new picture
    // Colour of the robot's shell from now on; nullopt: its own. Loaded skins keep theirs.
    void paint_shell(const std::optional<Color>& color) { shell_ = color; }
    void add(HandSide side, const Pose& wrist_ws,
             const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
             RenderFrame& frame) {
        add(side, wrist_ws, wrist_ws.rotation, fingers, renderer, frame);
    }
    // `forearm_ws`: rotation of the forearm (-Z to the hand); the robot's cuff turns with it.
    void add(HandSide side, const Pose& wrist_ws, const Quat& forearm_ws,
             const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
             RenderFrame& frame);

    const HandRig& rig(HandSide side) const { return models_[index_of(side)].rig; }

  private:
    // A part of the robot's hand on the graphics card.
    struct Part {
        std::int32_t finger = RigJoint::k_palm;
        std::uint32_t link = 0;
        MeshId mesh{};
        Look look;
        bool is_cuff = false;
        bool is_shell = false;
    };
    // Meshes of one drawn hand, one per colour of its skin. A skin deforms, so hands share no mesh.
    using SkinCopy = std::vector<MeshId>;

    void add_parts(HandSide side, const Pose& wrist_ws, const Quat& forearm_ws,
                   const std::array<FingerAngles, k_finger_count>& fingers,
                   RenderFrame& frame) const;
    void add_skin(HandSide side, const Pose& wrist_ws,
                  const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
                  RenderFrame& frame);

    HandModels models_;
    std::optional<Color> shell_;
    std::array<std::vector<Part>, k_hand_count> parts_;
    std::array<std::vector<SkinCopy>, k_hand_count> copies_;
    std::array<std::size_t, k_hand_count> used_ = {};  // copies used in this picture
    std::vector<Vec3> positions_, normals_;            // scratch
};

}  // namespace handhold
