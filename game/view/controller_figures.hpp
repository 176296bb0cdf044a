#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "game/devices/controller_profile.hpp"
#include "game/mesh/level_meshes.hpp"
#include "game/render/hand_figures.hpp"
#include "game/session/hand_pose.hpp"

// Draws controllers in hands that hold nothing else.
namespace handhold {

struct ControllerModel {
    std::vector<LevelMesh> meshes;
    // The movements of meshes[i] with the controls, outermost first, by index in `meshes`.
    std::vector<std::vector<ControlMove>> moves;
    ControllerFit fit;
};
struct ControllerModels {
    std::string name;
    std::array<ControllerModel, k_hand_count> sides;  // indexed by HandSide
    bool has_own_joint = false;                       // false: Tuning's joint applies
    std::vector<std::string> notes = {};  // remarks about the loaded files; see GltfLevel::notes

    std::array<hh::Pose, 2> joints() const;
};

// The built-in model: a wand held in the fist. Its pose relative to the hand follows from the
// tuning (default_controller_to_hand).
ControllerModels builtin_controllers(const HandShape& shape);
// `name_or_file`: "builtin", or the file of a profile with its models. Errors name the file, the
// place in it, and what was expected.
Result<ControllerModels> choose_controllers(const std::string& name_or_file);

// Closes a rig's fingers on the controller until they touch it.
std::array<FingerAngles, k_finger_count> fingers_around(const ControllerModel& model,
                                                        const HandRig& rig);

// The meshes of both sides in one renderer.
class ControllerFigures {
  public:
    ControllerFigures(const ControllerModels& models, const HandFigures& hands, Renderer& renderer);

    void add(HandSide side, const Pose& wrist_ws, const ControlValues& values,
             RenderFrame& frame) const;
    // Fingers of the hand that holds the controller.
    const std::array<FingerAngles, k_finger_count>& fingers(HandSide side) const {
        return sides_[index_of(side)].fingers;
    }

  private:
    struct Part {
        MeshId mesh{};
        Look look;
        std::vector<ControlMove> moves;
    };
    struct Side {
        std::vector<Part> parts;
        Pose in_hand;
        std::array<FingerAngles, k_finger_count> fingers;
    };
    std::array<Side, k_hand_count> sides_;
};

}  // namespace handhold
