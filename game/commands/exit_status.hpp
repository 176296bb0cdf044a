#pragma once

#include <span>
#include <string>

#include "engine/io/result.hpp"

// What the program's commands exit with, beside 0.
namespace handhold {

inline constexpr int k_exit_bad_file = 2;
inline constexpr int k_exit_no_window = 3;

// Says what is wrong with a file and gives the status for that.
int refuse(const FileError& error);

// Prints remarks about files that were loaded, a line each, to stderr.
void print_notes(std::span<const std::string> notes);

}  // namespace handhold
