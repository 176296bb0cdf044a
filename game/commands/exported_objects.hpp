#pragma once

#include <string>
#include <vector>

#include "engine/io/gltf_skin_writer.hpp"
#include "game/view/controller_figures.hpp"

// Objects beside a hand in a .glb for animation software. Talk row 9.
namespace handhold {

// The mesh with normals, moved by `pose`, as a surface with the given name and material.
GltfSurface exported_surface(const std::string& name, const Mesh& mesh, const Pose& pose,
                             std::size_t material);

// Extras of a controller's part: its pose relative to its rest pose, as position and quaternion
// x, y, z, w, with the control pressed.
inline constexpr const char* k_pressed_trigger_key = "pressed_trigger";
inline constexpr const char* k_pressed_squeeze_key = "pressed_squeeze";

// The node "controller", empty, at the tracked pose, and nodes "controller-part-0" and so on with
// the model. Poses are in hand space. Appends the parts' materials to `materials`.
std::vector<GltfObject> controller_objects(const ControllerModel& model,
                                           std::vector<GltfMaterial>& materials);

}  // namespace handhold
