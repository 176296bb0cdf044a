#pragma once

#include <string>
#include <string_view>

// Makes names from files and scenes safe to use in paths.
namespace handhold {

constexpr std::size_t k_max_file_name_bytes = 100;

// Returns `name` as a single path component: file_name(name) + ".png" joined to a folder is a file
// directly inside that folder, whatever the name is. Letters, digits, spaces, valid UTF-8 and most
// punctuation stay. Encoded as %NN: path separators, control and invisible characters, invalid
// UTF-8, what shells or other file systems treat specially (% : * ? " ' < > | $ ` \ ; & ! ~), a
// leading dot or dash, and dots or spaces at the ends. Different names give different results. A
// name longer than k_max_file_name_bytes is cut and ends in a hash of the whole name. An empty name
// gives "%".
std::string file_name(std::string_view name);

// True if file_name(name) == name.
bool is_file_name(std::string_view name);

}  // namespace handhold
