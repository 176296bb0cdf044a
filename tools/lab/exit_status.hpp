#pragma once

#include "engine/io/result.hpp"

// What the lab's commands exit with, beside 0.
namespace handhold::lab {

inline constexpr int k_exit_usage = 1;
inline constexpr int k_exit_file = 2;

// Says what is wrong with a file and gives the status for that.
int refuse(const FileError& error);

}  // namespace handhold::lab
