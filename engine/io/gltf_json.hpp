#pragma once

#include <cstddef>
#include <vector>

#include "engine/io/gltf_model.hpp"
#include "engine/io/json.hpp"

// Functions that the parts of the document parser share. Private to engine/io/gltf*.
namespace handhold::gltf {

// The numbers of an array, which must have `count` elements. Empty if the array is absent.
std::vector<double> read_numbers(const JsonValue& array, std::size_t count);

// The extension `name` of an object. Does not exist if the object has no such extension.
JsonValue extension_of(const JsonValue& object, const char* name);

// Clamps factors to the specification's range and adds their number to `clamped`.
Material parse_material(const JsonValue& value, std::size_t& clamped);

}  // namespace handhold::gltf
