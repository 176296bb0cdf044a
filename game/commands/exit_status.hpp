#pragma once

#include <span>
#include <string>

#include "engine/io/result.hpp"

// Exit statuses of the commands besides 0, and 1 for wrong flags.
namespace handhold {

inline constexpr int k_exit_bad_file = 2;
inline constexpr int k_exit_no_window = 3;
inline constexpr int k_exit_internal = 4;       // out of memory, or an error of the program
inline constexpr int k_exit_interrupted = 130;  // by SIGINT or SIGTERM; files are whole

// Prints the error on standard error and returns k_exit_bad_file.
int refuse(const FileError& error);

// Prints remarks about files that were loaded, a line each, to stderr.
void print_notes(std::span<const std::string> notes);

}  // namespace handhold
