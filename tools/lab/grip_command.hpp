#pragma once

#include <filesystem>
#include <string>

// `handhold-lab grip`: poses a hand on a mesh for each placement, as JSON lines.
namespace handhold::lab {

struct GripOptions {
    std::filesystem::path mesh;
    std::string rig = "builtin";  // "builtin", or the file of a skinned hand
    std::string hand = "right";
    std::filesystem::path placements;
    std::filesystem::path out;
    std::string sync = "on";
    std::string search = "astar";
    std::string palm = "least";
    // "fit" or a baseline (finger_baselines.hpp); empty: "talk" if `search` needs it, else "fit".
    std::string fingers;
    double grip_edge_mm = 20.0;
    int shown_after = 0;             // GripVariant::shown_after
    std::filesystem::path rig_json;  // empty: not written
    // Number of frames for which each hand moves as recorded; then it stands still for as many. 0:
    // not measured.
    int warm_frames = 0;
    std::filesystem::path motions;    // output of `recorded-grips`
    std::filesystem::path moved_out;  // hands at the end of their motion; empty: not written
    std::filesystem::path warm_json;  // figures of every frame; empty: not written
};

// Exit status: 0, or 2 with one line on standard error if a file cannot be read or written. No
// output file is left half written.
int grip_command(const GripOptions& options);

}  // namespace handhold::lab
