#pragma once

#include <filesystem>
#include <string>
#include <vector>

// `handhold-lab solve`: solves a scene with one solver and writes figures as JSON and poses as CSV.
namespace handhold::lab {

struct SolveOptions {
    std::string scene;
    int links = 0;  // 0: the scene's default
    std::string masses = "uniform";
    std::string holder = "player";
    std::string solver = "direct";
    int frames = 900;
    double hz = 90.0;
    int residual_frame = -1;  // frame whose residual curve is recorded; -1: none
    std::filesystem::path json;
    std::filesystem::path csv;
};

std::vector<std::string> solver_names();

// Exit status: 0; 1 if this solver or holder cannot express the scene; 2 if a file cannot be
// written. Errors are one line on standard error.
int solve_command(const SolveOptions& options);

}  // namespace handhold::lab
