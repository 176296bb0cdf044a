#pragma once

#include <string>
#include <vector>

namespace handhold {

struct ExportGripOptions {
    std::string scene;
    std::string body;
    std::string grip;  // an authored grip's name, or that of a new one
    std::string hand = "right";
    std::vector<double> wrist;  // of a new one: x, y, z, quaternion x, y, z, w in the body's frame,
                                // where the hand would close; it is fitted from there
    std::string out;
};
// `handhold export-grip`: hand, controller and thing as a .glb. Returns the exit status: 0, or 2
// after one line on standard error.
int export_grip_command(const ExportGripOptions& options);

// `handhold import-grip`: such a file as an object for a scene file's "grips", to a file or, where
// `out` is empty, to standard output.
int import_grip_command(const std::string& file, const std::string& out);

}  // namespace handhold
