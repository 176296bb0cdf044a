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
    // moves[i]: how the controls move meshes[i], outermost move first.
    std::vector<std::vector<ControlMove>> moves;
    ControllerFit fit;
};
struct ControllerModels {
    std::string name;
    std::array<ControllerModel, k_hand_count> sides;  // indexed by HandSide
    // True: the models define the hands' poses in the controllers; false: the tuning's poses apply.
    bool has_own_joint = false;
    std::vector<std::string> notes = {};  // remarks about the loaded files; see GltfLevel::notes

    // The hands' poses in the controllers' grip frames, indexed by hh::Side.
    std::array<hh::Pose, 2> joints() const;
};

// The built-in model: a wand held in the fist. Its pose relative to the hand follows from the
// tuning (default_controller_to_hand).
ControllerModels builtin_controllers(const HandShape& shape);
// `name_or_file`: "builtin", or the file of a profile with its models. Errors name the file, the
// place in it, and what was expected.
Result<ControllerModels> choose_controllers(const std::string& name_or_file);

// Closes a rig's fingers on the controller, with its controls at `values`, until they touch it.
std::array<FingerAngles, k_finger_count> fingers_around(
    const ControllerModel& model, const HandRig& rig,
    const ControlValues& values = k_controls_at_rest);

// Fingers that follow the parts on which they rest; the index finger bends with the trigger
// wherever it is. Angles are indexed as HandRig::fingers.
class FollowingFingers {
  public:
    FollowingFingers() = default;
    // Fits the hand three times: on the controller at rest, with its trigger pressed, and with its
    // squeeze button pressed.
    FollowingFingers(const ControllerModel& model, const HandRig& rig);
    // The pose at rest plus, for trigger and squeeze button, the pressed angles' difference times
    // the control's value.
    std::array<FingerAngles, k_finger_count> at(const ControlValues& values) const;

  private:
    std::array<FingerAngles, k_finger_count> rest_;
    std::array<FingerAngles, k_finger_count> trigger_;
    std::array<FingerAngles, k_finger_count> squeeze_;
};

// The meshes of both sides in one renderer.
class ControllerFigures {
  public:
    ControllerFigures(const ControllerModels& models, const HandFigures& hands, Renderer& renderer);

    void add(HandSide side, const Pose& wrist_ws, const ControlValues& values,
             RenderFrame& frame) const;
    // Fingers of the hand that holds the controller.
    std::array<FingerAngles, k_finger_count> fingers(HandSide side,
                                                     const ControlValues& values) const {
        return sides_[index_of(side)].fingers.at(values);
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
        FollowingFingers fingers;
    };
    std::array<Side, k_hand_count> sides_;
};

}  // namespace handhold
