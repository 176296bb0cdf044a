#include "game/levels/load_scene.hpp"

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "game/levels/built_in_scenes.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {
namespace {

// A scene that contains only a level: each of its mesh nodes becomes a static body.
SceneFile level_scene(const std::filesystem::path& path) {
    SceneFile file;
    file.name = path.stem().string();
    file.description = "a level by itself";
    file.levels.push_back({path, {}, Vec3::Ones()});
    return file;
}

}  // namespace

Result<Scene> load_scene(const std::string& name_or_file) {
    if (std::optional<Scene> scene = make_built_in_scene(name_or_file)) {
        return std::move(*scene);
    }
    const std::filesystem::path path = name_or_file;
    if (path.extension() == ".glb" || path.extension() == ".gltf") {
        return build_scene(level_scene(path), path);
    }
    if (path.extension() != ".json") {
        std::string names;
        for (const std::string_view name : built_in_scenes()) {
            names += std::string(name) + ", ";
        }
        return FileError{name_or_file, "",
                         "expected " + names + "a .json scene or a .glb or .gltf level"};
    }
    Result<SceneFile> file = load_scene_file(path);
    if (!file) {
        return file.error();
    }
    return build_scene(file.value(), path);
}

}  // namespace handhold
