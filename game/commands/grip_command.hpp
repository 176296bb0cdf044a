#pragma once

#include <string>
#include <vector>

namespace handhold {

struct ExportGripOptions {
    std::string scene;
    std::string body;
    std::string grip;  // name of an authored grip, or of a new one
    std::string hand = "right";
    std::vector<double> wrist;  // of a new grip: x, y, z, quaternion x, y, z, w in the body's
                                // frame, where the hand closes; the fit starts there
    std::string out;
};
// `handhold export-grip`: hand, controller and object as a .glb. Returns the exit status: 0, or 2
// after one line on standard error.
int export_grip_command(const ExportGripOptions& options);

// `handhold import-grip`: such a file as an object for a scene file's "grips", into a file, or to
// standard output if `out` is empty.
int import_grip_command(const std::string& file, const std::string& out);

}  // namespace handhold
