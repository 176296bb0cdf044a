#pragma once

#include <cstddef>
#include <vector>

#include "engine/io/gltf_model.hpp"
#include "engine/io/json.hpp"

// Parts of the document parser. Private to engine/io/gltf*.
namespace handhold::gltf {

// The numbers of an array of `count`. Empty if the array is absent.
std::vector<double> read_numbers(const JsonValue& array, std::size_t count);

// An extension of an object. It does not exist if the object does not have it.
JsonValue extension_of(const JsonValue& object, const char* name);

// Adds the number of clamped factors to `clamped`.
Material parse_material(const JsonValue& value, std::size_t& clamped);

}  // namespace handhold::gltf
