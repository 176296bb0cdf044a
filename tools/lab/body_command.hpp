#pragma once

#include <filesystem>
#include <string>
#include <vector>

// `handhold-lab body`: the runtime's arms and chest over recorded heads and hands.
namespace handhold::lab {

struct BodyOptions {
    std::filesystem::path in;
    std::filesystem::path calib;
    std::filesystem::path out;
    std::string estimator = "full";
};

// "full": the runtime's systems; the others are what to compare it with (body_baselines.hpp).
std::vector<std::string> estimator_names();

// Exit status: 0; 2 for a file that cannot be read or written. One line on standard error says why.
int body_command(const BodyOptions& options);

}  // namespace handhold::lab
