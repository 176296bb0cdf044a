#pragma once

#include <span>
#include <string>

#include "game/files/file_tools.hpp"

// Exit statuses of the commands. Besides these: 0 for success, 1 for wrong options.
namespace handhold {

inline constexpr int k_exit_bad_file = 2;
inline constexpr int k_exit_no_window = 3;
inline constexpr int k_exit_internal = 4;  // out of memory, or an error of the program
// Ended by SIGINT or SIGTERM. Every file that was written is complete.
inline constexpr int k_exit_interrupted = 130;

// Prints the error on standard error and returns k_exit_bad_file.
int refuse(const FileError& error);

// Prints the notes about loaded files to standard error, one per line.
void print_notes(std::span<const std::string> notes);

}  // namespace handhold
