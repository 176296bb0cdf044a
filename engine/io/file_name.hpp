#pragma once

#include <string>
#include <string_view>

// The one rule for names that come from a file or a scene and become part of a path.
namespace handhold {

constexpr std::size_t k_max_file_name_bytes = 100;

// `name` as a single path component: file_name(name) + ".png" joined to a folder is a file directly
// inside that folder, whatever the name is. Letters, digits, spaces, valid UTF-8 and most
// punctuation stay. Encoded as %NN: path separators, control and invisible characters, invalid
// UTF-8, what shells or other file systems treat specially (% : * ? " ' < > | $ ` \ ; & ! ~), a
// leading dot or dash, and dots or spaces at the ends. Equal results mean equal names; only names
// longer than k_max_file_name_bytes are cut and end in a hash of the whole. Empty gives "%".
std::string file_name(std::string_view name);

// True if `name` is its own file_name.
bool is_file_name(std::string_view name);

}  // namespace handhold
