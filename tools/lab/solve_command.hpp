#pragma once

#include <filesystem>
#include <string>
#include <vector>

// `handhold-lab solve`: one scene, one solver, the figures as JSON and the poses as CSV.
namespace handhold::lab {

struct SolveOptions {
    std::string scene;
    int links = 0;  // 0: the scene's own
    std::string masses = "uniform";
    std::string holder = "player";
    std::string solver = "direct";
    int frames = 900;
    double hz = 90.0;
    int residual_frame = -1;  // none
    std::filesystem::path json;
    std::filesystem::path csv;
};

std::vector<std::string> solver_names();

// Exit status: 0; 1 for what this solver or holder cannot express; 2 for a file that cannot be
// written. One line on standard error says why.
int solve_command(const SolveOptions& options);

}  // namespace handhold::lab
