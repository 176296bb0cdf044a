// Levels from glTF files (handhold/level.h).
#include <memory>
#include <string>
#include <vector>

#include "engine/io/gltf.hpp"
#include "systems/host/host_world.hpp"

namespace handhold {
namespace {

struct NewMesh {
    std::string name;
    std::unique_ptr<hh_mesh, void (*)(hh_mesh*)> mesh{nullptr, hh_mesh_destroy};
};

std::vector<NewMesh> read_level(const hh_world& host, const void* gltf, std::size_t size) {
    Result<GltfLevel> level = parse_gltf_level({static_cast<const char*>(gltf), size}, {});
    if (!level) {
        FileError error = level.error();
        error.file = "level";
        throw HostError{HH_ERROR_DATA, error.message()};
    }
    std::vector<NewMesh> meshes;
    for (LevelPart& part : level.value().parts) {
        if (part.mesh.triangles.empty()) {
            continue;
        }
        auto made = std::make_unique<hh_mesh>();
        NewMesh added;
        added.name = part.mesh.name;
        made->mesh = std::make_shared<const Mesh>(std::move(part.mesh));
        made->tree = build_triangle_tree(*made->mesh);
        if (host.settings.fits_hands) {
            made->grip = std::make_shared<const GripMesh>(build_grip_mesh(*made->mesh));
        }
        added.mesh.reset(made.release());
        meshes.push_back(std::move(added));
    }
    return meshes;
}

std::string free_name(const hh_world& host, const std::string& name) {
    std::string free = name;
    hh_body taken{};
    for (int number = 2; hh_body_find(&host, free.c_str(), &taken) == HH_OK; ++number) {
        free = name + " " + std::to_string(number);
    }
    return free;
}

struct Added {
    hh_shape shape{};
    hh_body body{};
};

// Throws, and adds nothing, for what hh_body_add refuses.
Added add_mesh_body(hh_world& host, const NewMesh& part, const hh_pose& pose) {
    hh_body_def def = hh_default_body_def();
    const std::string name = free_name(host, part.name);
    def.name = name.c_str();
    def.kind = HH_STATIC;
    def.pose = pose;
    Added added;
    hh_result result = hh_shape_add_mesh(&host, part.mesh.get(), {1.0, 1.0, 1.0}, &def.shape);
    if (result != HH_OK) {
        throw HostError{result, hh_last_error()};
    }
    added.shape = def.shape;
    result = hh_body_add(&host, &def, &added.body);
    if (result != HH_OK) {
        const HostError error{result, hh_last_error()};
        hh_shape_remove(&host, added.shape);
        throw error;
    }
    return added;
}

// Adds all bodies, or throws and adds none.
std::vector<Added> add_all(hh_world& host, const std::vector<NewMesh>& meshes,
                           const hh_pose& pose) {
    std::vector<Added> added;
    added.reserve(meshes.size());
    try {
        for (const NewMesh& mesh : meshes) {
            added.push_back(add_mesh_body(host, mesh, pose));
        }
    } catch (...) {
        for (const Added& one : added) {
            hh_body_remove(&host, one.body);
            hh_shape_remove(&host, one.shape);
        }
        throw;
    }
    return added;
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_world_add_gltf_level(hh_world* world, const void* gltf, size_t size, hh_pose pose,
                                  hh_body* bodies, size_t capacity, size_t* count) {
    std::vector<NewMesh> meshes;
    const hh_result read = call([&] {
        const hh_world& host = world_of(world);
        require_idle(host);
        require(gltf != nullptr && count != nullptr, HH_ERROR_NULL,
                "the bytes or the count are null");
        checked(pose);
        meshes = read_level(host, gltf, size);
        *count = meshes.size();
        require(bodies == nullptr || meshes.size() <= capacity, HH_ERROR_CAPACITY,
                "the buffer is too small for the level's bodies");
    });
    if (read != HH_OK) {
        return read;
    }
    return call([&] {
        const std::vector<Added> added = add_all(*world, meshes, pose);
        for (std::size_t i = 0; bodies != nullptr && i < added.size(); ++i) {
            bodies[i] = added[i].body;
        }
    });
}
