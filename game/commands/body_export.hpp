#pragma once

#include <string>

namespace handhold {

// `handhold export-body`: writes the robot's body as a figure in T-pose (make_robot_body_glb).
// Returns the exit status.
int export_body_command(const std::string& file);

}  // namespace handhold
