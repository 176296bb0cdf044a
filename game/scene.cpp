#include "game/scene.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "components/tuning_json.hpp"
#include "engine/io/gltf.hpp"
#include "game/built_in_scenes.hpp"
#include "game/render/level_meshes.hpp"
#include "game/render/primitives.hpp"

namespace handhold {
namespace {

std::shared_ptr<const Mesh> moved_mesh(Mesh mesh, const Pose& pose) {
    for (Vec3& position : mesh.positions) {
        position = transform_point(pose, position);
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

// A static body that is not drawn.
Entity add_static_body(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws) {
    BodyDescription description;
    description.name = name;
    description.pose_ws = pose_ws;
    description.shape = scene.shapes->add_mesh(std::move(mesh));
    scene.body_names.push_back(name);
    return add_body(scene.world, description);
}

// Builds a scene file's bodies one by one; the first error is kept and ends it.
class SceneBuilder {
  public:
    SceneBuilder(const SceneFile& file, const std::filesystem::path& path, Scene& scene)
        : file_(file), path_(path), scene_(scene) {}

    std::optional<FileError> build() {
        for (std::size_t i = 0; i < file_.levels.size(); ++i) {
            place_ = "/levels/" + std::to_string(i);
            add_level(file_.levels[i]);
        }
        for (std::size_t i = 0; i < file_.bodies.size(); ++i) {
            place_ = "/bodies/" + std::to_string(i) + "/name";
            add_scene_body(file_.bodies[i]);
        }
        for (const SceneSpawn& spawn : file_.spawns) {
            scene_.spawns.push_back({spawn.name, file_.world_transform * spawn.pose});
        }
        for (std::size_t i = 0; i < file_.players.size(); ++i) {
            place_ = "/players/" + std::to_string(i) + "/name";
            add_player_start(file_.players[i]);
        }
        return error_;
    }

  private:
    // The file's own names differ, but parts of levels and players' hands get theirs here. False,
    // with the error kept, where somebody has it already.
    bool take_name(const std::string& name) {
        if (!error_ && !names_.insert(name).second) {
            error_ =
                FileError{path_.string(), place_,
                          "expected names that nothing else has, found \"" + name + "\" twice"};
        }
        return !error_;
    }

    Vec3 turned(const Vec3& vector) const { return file_.world_transform.rotation * vector; }

    // Null, with the error kept, where the file is refused.
    std::optional<GltfLevel> load(const std::filesystem::path& path) {
        if (error_) {
            return std::nullopt;
        }
        Result<GltfLevel> level = load_gltf_level(path);
        if (!level) {
            error_ = level.error();
            return std::nullopt;
        }
        return std::move(level.value());
    }

    void add_level(const SceneLevel& level) {
        std::optional<GltfLevel> loaded = load(level.file);
        if (!loaded) {
            return;
        }
        const std::string stem = level.file.stem().string();
        std::vector<Entity> bodies;
        for (std::size_t i = 0; i < loaded->parts.size(); ++i) {
            const Mesh& mesh = loaded->parts[i].mesh;
            if (!mesh.triangles.empty()) {
                const std::string name = stem + "/" + std::to_string(i) + "/" + mesh.name;
                if (!take_name(name)) {
                    return;
                }
                bodies.push_back(add_static_body(scene_, name, moved_mesh(mesh, level.pose),
                                                 file_.world_transform));
            }
        }
        for (Mesh& mesh : make_level_meshes(*loaded)) {
            if (!bodies.empty()) {  // level meshes stand still together: any of its bodies carries
                                    // the picture
                scene_.visuals.push_back(
                    {bodies.front(), moved_mesh(std::move(mesh), level.pose), std::nullopt, {}});
            }
        }
    }

    ShapeId add_shape(const SceneShape& shape, std::shared_ptr<const Mesh>& visual) {
        switch (shape.type) {
            case SceneShapeType::box:
                visual = std::make_shared<const Mesh>(make_box(shape.half_m));
                return scene_.shapes->add_box(shape.half_m);
            case SceneShapeType::sphere:
                visual = std::make_shared<const Mesh>(make_sphere(shape.radius_m));
                return scene_.shapes->add_sphere(shape.radius_m);
            case SceneShapeType::capsule:
                visual = std::make_shared<const Mesh>(
                    make_capsule(-shape.half_height_m * Vec3::UnitY(),
                                 shape.half_height_m * Vec3::UnitY(), shape.radius_m));
                return scene_.shapes->add_capsule(shape.radius_m, shape.half_height_m);
            case SceneShapeType::mesh:
                break;
        }
        std::optional<GltfLevel> loaded = load(shape.file);
        if (!loaded) {
            return {};
        }
        Mesh whole;
        for (const LevelPart& part : loaded->parts) {
            append(whole, part.mesh);
            whole.color = part.mesh.color;
        }
        if (whole.triangles.empty()) {
            error_ =
                FileError{shape.file.string(), "", "expected at least one triangle, found none"};
            return {};
        }
        visual = std::make_shared<const Mesh>(std::move(whole));
        return scene_.shapes->add_mesh(visual);
    }

    void add_scene_body(const SceneBody& body) {
        std::shared_ptr<const Mesh> visual;
        const ShapeId shape = add_shape(body.shape, visual);
        if (error_ || !take_name(body.name)) {
            return;
        }
        BodyDescription description;
        description.name = body.name;
        description.body.kind = body.kind;
        description.body.restitution = body.restitution;
        description.pose_ws = file_.world_transform * body.pose;
        description.shape = shape;
        if (body.kind == BodyKind::free) {
            description.body.mass_kg = body.mass_kg;
            description.body.inertia_kgm2 =
                body.inertia_kgm2 ? *body.inertia_kgm2
                                  : solid_inertia(scene_.shapes->at(shape), body.mass_kg);
            description.velocity = {turned(body.velocity_mps), turned(body.angular_velocity_radps)};
        }
        const Entity entity = add_body(scene_.world, description);
        scene_.body_names.push_back(body.name);
        if (body.kind == BodyKind::kinematic) {
            const Mover mover{description.pose_ws, turned(body.motion.velocity_mps),
                              turned(body.motion.angular_velocity_radps),
                              body.motion.turns_with_body};
            scene_.world.mover.add(entity, mover);
            scene_.world.body_velocity.at(entity) = {mover.velocity_ws_mps,
                                                     mover.angular_velocity_ws_radps};
        }
        std::optional<Color> color;
        if (body.color) {
            color = *body.color;
        }
        scene_.visuals.push_back({entity, visual, color, {}});
    }

    void add_player_start(const ScenePlayer& player) {
        for (const char* const part : {"", "/left_hand", "/right_hand"}) {
            if (!take_name(player.name + part)) {
                return;
            }
        }
        const auto spawn = std::find_if(
            scene_.spawns.begin(), scene_.spawns.end(),
            [&player](const SceneSpawnPoint& point) { return point.name == player.spawn; });
        scene_.players.push_back({player.name, spawn->pose_ws, player.mass_kg});
    }

    const SceneFile& file_;
    const std::filesystem::path& path_;
    Scene& scene_;
    std::string place_;            // of what is being added
    std::set<std::string> names_;  // taken
    std::optional<FileError> error_;
};

// Any level by itself: its mesh nodes are static bodies, and nothing else is there.
SceneFile level_scene(const std::filesystem::path& path) {
    SceneFile file;
    file.name = path.stem().string();
    file.description = "a level by itself";
    file.levels.push_back({path, {}});
    return file;
}

}  // namespace

Entity add_static_mesh(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws, const Look& look) {
    const Entity entity = add_static_body(scene, name, mesh, pose_ws);
    scene.visuals.push_back({entity, std::move(mesh), std::nullopt, look});
    return entity;
}

Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path) {
    Result<Tuning> tuning = parse_tuning(file.tuning_json, path.string());
    if (!tuning) {
        return tuning.error();
    }
    Scene scene;
    scene.name = file.name;
    scene.description = file.description;
    scene.tuning = tuning.value();
    scene.session = file.session;
    scene.up_ws = file.world_transform.rotation * Vec3::UnitY();
    scene.world.reference_velocity_mps =
        file.world_transform.rotation * file.reference_velocity_mps;
    scene.head_shape = scene.shapes->add_sphere(scene.tuning.head.radius_m);
    if (std::optional<FileError> error = SceneBuilder(file, path, scene).build()) {
        return *error;
    }
    return scene;
}

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

std::string free_player_name(const World& world, std::string wanted) {
    const auto is_taken = [&world](const std::string& name) {
        return !is_null(find_by_id(world, persistent_id_from_name(name)));
    };
    while (is_taken(wanted) || is_taken(wanted + "/left_hand") ||
           is_taken(wanted + "/right_hand")) {
        wanted += "'";
    }
    return wanted;
}

PlayerEntities add_scene_player(Scene& scene, const ScenePlayerStart& start) {
    PlayerDescription description;
    description.name = start.name;
    description.body.mass_kg = start.mass_kg;
    description.origin_ws = start.origin_ws;
    description.velocity_mps = scene.world.reference_velocity_mps;
    description.head_shape = scene.head_shape;
    return add_player(scene.world, description);
}

}  // namespace handhold
