#pragma once

// Meshes and skinned figures from glTF files. Errors name the file, the place and what was
// expected.
#include "engine/io/gltf.hpp"
#include "engine/io/result.hpp"
