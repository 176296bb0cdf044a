#include "game/scene.hpp"

#include <algorithm>
#include <utility>

#include "components/tuning_json.hpp"
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
    SceneBuilder(const SceneFile& file, const LevelSource& levels, Scene& scene)
        : file_(file), levels_(levels), scene_(scene) {}

    std::optional<FileError> build() {
        for (const SceneLevel& level : file_.levels) {
            add_level(level);
        }
        for (const SceneBody& body : file_.bodies) {
            add_scene_body(body);
        }
        for (Lamp lamp : file_.lamps) {
            lamp.position_ws = transform_point(file_.world_transform, lamp.position_ws);
            scene_.lamps.push_back(lamp);
        }
        for (const SceneSpawn& spawn : file_.spawns) {
            scene_.spawns.push_back({spawn.name, file_.world_transform * spawn.pose});
        }
        return error_;
    }

  private:
    Vec3 turned(const Vec3& vector) const { return file_.world_transform.rotation * vector; }

    // Null, with the error kept, where the file is refused.
    std::optional<GltfLevel> load(const std::filesystem::path& path) {
        if (error_) {
            return std::nullopt;
        }
        Result<GltfLevel> level = levels_(path);
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
                bodies.push_back(add_static_body(scene_, name, moved_mesh(mesh, level.pose),
                                                 file_.world_transform));
            }
        }
        if (!bodies.empty()) {  // they stand still together: any of them carries the pictures
            add_visuals(bodies.front(), *loaded, level.pose);
        }
    }

    void add_visuals(Entity body, const GltfLevel& level, const Pose& pose_bs) {
        for (LevelMesh& part : make_level_meshes(level)) {
            scene_.visuals.push_back(
                {body, moved_mesh(std::move(part.mesh), pose_bs), std::nullopt, part.look});
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
        if (error_) {
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
            set_moving(body, entity);
        }
        if (body.visual.empty()) {
            scene_.visuals.push_back({entity, visual, body.color, {}});
        } else if (const std::optional<GltfLevel> drawn = load(body.visual)) {
            add_visuals(entity, *drawn, {});
        }
    }

    void set_moving(const SceneBody& body, Entity entity) {
        BodyVelocity& velocity = scene_.world.body_velocity.at(entity);
        if (body.motion.path) {
            std::vector<Pose> poses = body.motion.path->poses;
            for (Pose& pose : poses) {
                pose = file_.world_transform * pose;
            }
            const PathMover mover{make_pose_path(poses, body.motion.path->period_s)};
            scene_.world.path_mover.add(entity, mover);
            const PosePathState state = evaluate(mover.path, 0.0);
            velocity = {state.velocity_mps, state.angular_velocity_radps};
            return;
        }
        const Mover mover{scene_.world.body_pose.at(entity).pose_ws,
                          turned(body.motion.velocity_mps),
                          turned(body.motion.angular_velocity_radps), body.motion.turns_with_body};
        scene_.world.mover.add(entity, mover);
        velocity = {mover.velocity_ws_mps, mover.angular_velocity_ws_radps};
    }

    const SceneFile& file_;
    const LevelSource& levels_;
    Scene& scene_;
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

Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path,
                          const LevelSource& levels) {
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
    if (std::optional<FileError> error = SceneBuilder(file, levels, scene).build()) {
        return *error;
    }
    for (const ScenePlayer& player : file.players) {
        const auto spawn = std::find_if(
            scene.spawns.begin(), scene.spawns.end(),
            [&player](const SceneSpawnPoint& point) { return point.name == player.spawn; });
        scene.players.push_back({player.name, spawn->pose_ws, player.mass_kg});
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
