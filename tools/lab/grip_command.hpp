#pragma once

#include <filesystem>
#include <string>

// `handhold-lab grip`: hands posed on a mesh, one a placement, as JSON lines.
namespace handhold::lab {

struct GripOptions {
    std::filesystem::path mesh;
    std::string rig = "builtin";  // or a skinned hand's file
    std::string hand = "right";
    std::filesystem::path placements;
    std::filesystem::path out;
    std::string sync = "on";
    std::string search = "astar";
    std::string palm = "least";
    std::string fingers = "sweep";  // or one to compare it with: finger_baselines.hpp
    double grip_edge_mm = 20.0;
    std::filesystem::path rig_json;  // empty: not written
    int warm_frames = 0;             // sliding, and standing still, of each hand; 0: none
    double speed_mps = 0.2;          // sliding
    std::filesystem::path slid_out;  // the hands as they are at the end of that; empty: not written
    std::filesystem::path warm_json;  // every frame's figures; empty: not written
};

// Exit status: 0; 2 for a file that cannot be read or written. One line on standard error says why;
// no output is left half written.
int grip_command(const GripOptions& options);

}  // namespace handhold::lab
