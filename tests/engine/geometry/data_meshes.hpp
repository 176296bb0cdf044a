#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/gltf.hpp"
#include "tests/places.hpp"

// Real meshes for the geometry tests: all parts of a file merged.
namespace handhold::test {

inline std::vector<std::filesystem::path> data_files(const char* folder) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path root = data_dir() / folder;
    if (std::filesystem::exists(root)) {
        for (const auto& entry : std::filesystem::directory_iterator(root)) {
            if (entry.path().extension() == ".glb") {
                files.push_back(entry.path());
            }
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

// Empty if the loader rejects the file.
inline Mesh load_whole(const std::filesystem::path& path) {
    Mesh whole;
    const Result<GltfLevel> level = load_gltf_level(path);
    if (!level) {
        return whole;
    }
    for (const LevelPart& part : level.value().parts) {
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        whole.positions.insert(whole.positions.end(), part.mesh.positions.begin(),
                               part.mesh.positions.end());
        for (const auto& [a, b, c] : part.mesh.triangles) {
            whole.triangles.push_back({first + a, first + b, first + c});
        }
    }
    whole.name = path.filename();
    return whole;
}

}  // namespace handhold::test
