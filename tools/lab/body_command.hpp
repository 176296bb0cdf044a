#pragma once

#include <filesystem>
#include <string>
#include <vector>

// `handhold-lab body`: estimates arms and chest from recorded heads and hands.
namespace handhold::lab {

struct BodyOptions {
    std::filesystem::path in;
    std::filesystem::path calib;
    std::filesystem::path out;
    std::filesystem::path looks;  // empty: none
    std::string estimator = "full";
};

// "full": the runtime's systems; the others are baselines (body_baselines.hpp).
std::vector<std::string> estimator_names();

// Exit status: 0, or 2 with one line on standard error if a file cannot be read or written.
int body_command(const BodyOptions& options);

}  // namespace handhold::lab
