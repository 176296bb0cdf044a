#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

// The container of a .glb file. Source: Khronos glTF 2.0 specification, section 4.
namespace handhold {

struct GlbChunks {
    std::string_view json;
    std::string_view binary;  // empty if the file has no binary chunk
};

// Splits a .glb into its chunks, which point into `bytes`. Bytes that do not begin with the magic
// number of a .glb are taken as the JSON of a .gltf. Refuses lengths that do not fit the file.
// `file` is used in messages.
Result<GlbChunks> split_glb(std::string_view bytes, const std::string& file);

// Joins a .glb. An empty `binary` writes no binary chunk.
std::string join_glb(std::string json, std::string_view binary);

// Little-endian.
void append_u32(std::string& bytes, std::uint32_t value);
std::uint32_t read_u32(std::string_view bytes, std::size_t offset);

}  // namespace handhold
