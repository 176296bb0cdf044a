#include "tests/places.hpp"

namespace handhold {

std::filesystem::path data_dir() { return HANDHOLD_DATA_DIR; }
std::filesystem::path source_dir() { return HANDHOLD_SOURCE_DIR; }
std::filesystem::path lab_program() { return HANDHOLD_LAB; }

}  // namespace handhold
