#pragma once

#include <string>
#include <vector>

namespace handhold {

struct ExportGripOptions {
    std::string scene;
    std::string body;
    std::string grip;  // name of an authored grip or of a new one
    std::string hand = "right";
    // New grip only: pose of the wrist where the hand closes and the fit starts, in the frame of
    // the body's shape in the scene file: x, y, z, then the quaternion's x, y, z, w.
    std::vector<double> wrist;
    std::string controllers;  // name or file for choose_controllers; empty: no model
    std::string out;
};
// `handhold export-grip`: writes hand, controller and object to a .glb. Returns the exit status: 0,
// or 2 after one line on standard error.
int export_grip_command(const ExportGripOptions& options);

// `handhold import-grip`: converts a .glb of `handhold export-grip` to a JSON object for "grips" in
// a scene file. Writes it to `out`, or to standard output if `out` is empty.
int import_grip_command(const std::string& file, const std::string& out);

}  // namespace handhold
