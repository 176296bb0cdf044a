#pragma once

#include "engine/core/result.hpp"

// Exit statuses of the lab's commands other than 0.
namespace handhold::lab {

inline constexpr int k_exit_usage = 1;
inline constexpr int k_exit_file = 2;

// Prints the error and returns its exit status.
int refuse(const FileError& error);

}  // namespace handhold::lab
