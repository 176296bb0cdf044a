#pragma once

#include <string>
#include <string_view>

#include "engine/io/result.hpp"

namespace handhold {

// Turns the bytes of a .gltf or .glb into a .glb that holds only what geometry needs, ready for a
// library that trusts its input: the container's lengths are right, every field that geometry reads
// has the type and range the specification gives it, buffers claim no more than the binary chunk
// has, nothing is nested deeply, and there are no images, textures, animations, skins and cameras
// to decode, unless the skins are wanted. References between the sections are not checked here.
// `file` is for messages.
enum class GltfUse { rigid, skinned };
Result<std::string> extract_geometry_glb(std::string_view bytes, const std::string& file,
                                         GltfUse use = GltfUse::rigid);

// A .glb of a JSON chunk and, where `binary` is not empty, a binary one (specification, section 4).
std::string join_glb(std::string json, std::string_view binary);

}  // namespace handhold
