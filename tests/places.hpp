#pragma once

#include <filesystem>

// Where tests find what is not theirs. Known to one source alone, so that all others compile to the
// same objects wherever the repository lies.
namespace handhold {

std::filesystem::path data_dir();    // real meshes and recordings; may be absent
std::filesystem::path source_dir();  // the repository
std::filesystem::path lab_program();

}  // namespace handhold
