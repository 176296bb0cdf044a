#pragma once

// Meshes and skinned figures from glTF files. Errors name the file, the place and what was
// expected.
#include "engine/core/result.hpp"
#include "engine/io/gltf.hpp"
