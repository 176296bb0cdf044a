#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/io/gltf_model.hpp"
#include "engine/io/json.hpp"

// Functions that all parts of the document parser use. Private to engine/io/gltf*.
namespace handhold::gltf {

// With these limits no sum or product of a count, a stride and an offset overflows 64 bits.
inline constexpr std::int64_t k_max_index = INT32_MAX;
inline constexpr std::int64_t k_max_size = UINT32_MAX;

inline constexpr const char* k_meshopt_extension = "EXT_meshopt_compression";

// An index into a section; k_none if it is absent.
int read_index(const JsonValue& value);
// A count of bytes or elements, at least `low`.
std::uint64_t read_size(const JsonValue& value, std::int64_t low = 0);
// An offset in bytes; 0 if it is absent.
std::uint64_t read_offset(const JsonValue& value);
// The indices of an array; empty if it is absent.
std::vector<int> read_index_array(const JsonValue& array);
// Indices of accessors by attribute name; empty if the object is absent.
std::map<std::string, int> read_attributes(const JsonValue& object);
// The numbers of an array, which must have `count` elements. Empty if the array is absent.
std::vector<double> read_numbers(const JsonValue& array, std::size_t count);

// The extension `name` of an object. Does not exist if the object has no such extension.
JsonValue extension_of(const JsonValue& object, const char* name);

// Clamps factors to the specification's range and adds their number to `clamped`.
Material parse_material(const JsonValue& value, std::size_t& clamped);

// Fills the model's buffers, views and accessors. Needs Model::binary.
void parse_data_layout(const JsonValue& root, Model& model);

}  // namespace handhold::gltf
