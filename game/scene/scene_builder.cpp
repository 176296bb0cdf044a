#include "game/scene/scene_builder.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "game/mesh/level_meshes.hpp"
#include "game/mesh/mesh_edit.hpp"
#include "game/scene/scene_shape.hpp"

namespace handhold {

Entity add_static_body(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws) {
    BodyDescription description;
    description.name = name;
    description.pose_ws = pose_ws;
    description.shape = scene.shapes().add_mesh(std::move(mesh));
    scene.body_names.push_back(name);
    return add_body(scene.world(), description, scene.shapes());
}

namespace {

std::shared_ptr<const Mesh> placed_mesh(Mesh mesh, const SceneLevel& level) {
    for (Vec3& position : mesh.positions) {
        position = transform_point(level.pose, position.cwiseProduct(level.scale));
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

// Builds a scene file's bodies one by one. Stops at the first error and keeps it.
class SceneBuilder {
  public:
    SceneBuilder(const SceneFile& file, const std::filesystem::path& path,
                 const LevelSource& levels, Scene& scene)
        : file_(file), path_(path), levels_(levels), scene_(scene) {}

    std::optional<FileError> build() {
        for (std::size_t i = 0; i < file_.levels.size(); ++i) {
            place_ = "/levels/" + std::to_string(i);
            add_level(file_.levels[i]);
        }
        for (std::size_t i = 0; i < file_.bodies.size(); ++i) {
            place_ = "/bodies/" + std::to_string(i) + "/name";
            add_scene_body(file_.bodies[i]);
        }
        for (std::size_t i = 0; i < file_.joints.size() && !error_; ++i) {
            place_ = "/joints/" + std::to_string(i) + "/name";
            add_scene_joint(file_.joints[i]);
        }
        for (Lamp lamp : file_.lamps) {
            lamp.position_ws = transform_point(file_.world_transform, lamp.position_ws);
            scene_.lamps.push_back(lamp);
        }
        for (const SceneSpawn& spawn : file_.spawns) {
            scene_.spawns.push_back({spawn.name, to_host(file_.world_transform * spawn.pose)});
        }
        for (std::size_t i = 0; i < file_.players.size(); ++i) {
            place_ = "/players/" + std::to_string(i) + "/name";
            add_player_start(file_.players[i]);
        }
        return error_;
    }

  private:
    // Reserves a name. Names within the file are already unique, but those of levels' parts and
    // players' hands are not. Returns false and sets error_ if the name is taken.
    bool take_name(const std::string& name) {
        if (!error_ && !names_.insert(name).second) {
            error_ =
                FileError{path_.string(), place_,
                          "expected names that nothing else has, found \"" + name + "\" twice"};
        }
        return !error_;
    }

    Vec3 turned(const Vec3& vector) const { return file_.world_transform.rotation * vector; }

    // Returns nullopt and sets error_ if the file cannot be loaded.
    std::optional<GltfLevel> load(const std::filesystem::path& path) {
        if (error_) {
            return std::nullopt;
        }
        Result<GltfLevel> level = levels_(path);
        if (!level) {
            error_ = level.error();
            return std::nullopt;
        }
        // Each note is listed once, even if several levels or bodies use the same file.
        for (const std::string& note : level.value().notes) {
            if (std::find(scene_.notes.begin(), scene_.notes.end(), note) == scene_.notes.end()) {
                scene_.notes.push_back(note);
            }
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
            refuse_size(level.file, mesh);
            if (error_) {
                return;
            }
            if (!mesh.triangles.empty()) {
                const std::string name = stem + "/" + std::to_string(i) + "/" + mesh.name;
                if (!take_name(name)) {
                    return;
                }
                bodies.push_back(
                    add_static_body(scene_, name, placed_mesh(mesh, level), file_.world_transform));
            }
        }
        // All parts are static, so the body of any part can carry the visuals.
        if (!bodies.empty()) {
            for (LevelMesh& part : make_level_meshes(*loaded)) {
                scene_.visuals.push_back({bodies.front(), placed_mesh(std::move(part.mesh), level),
                                          std::nullopt, part.look});
            }
        }
    }

    // Adds a model that is drawn instead of the body's shape.
    void add_visuals(Entity body, const GltfLevel& model, const Pose& pose_bs) {
        SceneLevel placed;
        placed.pose = pose_bs;
        for (LevelMesh& part : make_level_meshes(model)) {
            scene_.visuals.push_back(
                {body, placed_mesh(std::move(part.mesh), placed), std::nullopt, part.look});
        }
    }

    // Returns all parts of a file as one mesh. Bodies that name the same file share the mesh.
    std::shared_ptr<const Mesh> load_mesh(const std::filesystem::path& path) {
        std::shared_ptr<const Mesh>& mesh = meshes_[path];
        if (mesh != nullptr) {
            return mesh;
        }
        const std::optional<GltfLevel> loaded = load(path);
        if (!loaded) {
            return nullptr;
        }
        Mesh whole;
        for (const LevelPart& part : loaded->parts) {
            append(whole, part.mesh);
            whole.color = part.mesh.color;
        }
        refuse_size(path, whole);
        if (whole.triangles.empty()) {
            error_ = FileError{path.string(), "", "expected at least one triangle, found none"};
        }
        mesh = std::make_shared<const Mesh>(std::move(whole));
        return mesh;
    }

    void refuse_size(const std::filesystem::path& path, const Mesh& mesh) {
        if (mesh.triangles.size() > k_max_triangles) {
            error_ = FileError{path.string(), "",
                               "expected at most " + std::to_string(k_max_triangles) +
                                   " triangles in one mesh, found " +
                                   std::to_string(mesh.triangles.size())};
        }
    }

    ShapeId add_hull(const SceneShape& shape) {
        if (shape.file.empty()) {
            return scene_.shapes().add_hull(shape.hull);
        }
        const std::shared_ptr<const Mesh> mesh = load_mesh(shape.file);
        if (error_) {
            return {};
        }
        std::vector<Vec3> points = mesh->positions;
        for (Vec3& point : points) {
            point = point.cwiseProduct(shape.scale);
        }
        const std::optional<ConvexHull> hull = make_convex_hull(points);
        if (!hull || !is_solid(*hull)) {
            error_ = FileError{shape.file.string(), "",
                               "expected points that no two planes a millimetre apart hold between "
                               "them, 10 km wide at most"};
            return {};
        }
        return scene_.shapes().add_hull(*hull);
    }

    ShapeId add_compound(const SceneShape& shape) {
        std::vector<CompoundChild> children;
        for (const SceneShapePart& part : shape.parts) {
            children.push_back({add_shape(part.shape), part.pose, part.mass_kg});
        }
        return error_ ? ShapeId{} : scene_.shapes().add_compound(children);
    }

    ShapeId add_shape(const SceneShape& shape) {
        switch (shape.kind) {
            case ShapeKind::box:
                return scene_.shapes().add_box(shape.half_m);
            case ShapeKind::sphere:
                return scene_.shapes().add_sphere(shape.radius_m);
            case ShapeKind::capsule:
                return scene_.shapes().add_capsule(shape.radius_m, shape.half_height_m);
            case ShapeKind::cylinder:
                return scene_.shapes().add_cylinder(shape.radius_m, shape.half_height_m);
            case ShapeKind::hull:
                return add_hull(shape);
            case ShapeKind::compound:
                return add_compound(shape);
            case ShapeKind::mesh:
                break;
        }
        std::shared_ptr<const Mesh> mesh = load_mesh(shape.file);
        return error_ ? ShapeId{} : scene_.shapes().add_mesh(std::move(mesh), shape.scale);
    }

    void add_scene_body(const SceneBody& body) {
        CentredShape shape{add_shape(body.shape), {}};
        if (error_ || !take_name(body.name)) {
            return;
        }
        if (body.kind == BodyKind::free) {
            shape = scene_.shapes().add_centred(shape.shape);
        }
        BodyDescription description;
        description.name = body.name;
        description.body.kind = body.kind;
        description.body.restitution = body.restitution;
        description.body.friction = body.friction;
        description.pose_ws = file_.world_transform * body.pose * shape.frame;
        description.shape = shape.shape;
        if (body.kind == BodyKind::free) {
            description.body.mass_kg = body.mass_kg;
            description.body.inertia_kgm2 =
                body.inertia_kgm2 ? *body.inertia_kgm2
                                  : solid_inertia(scene_.shapes().at(shape.shape), body.mass_kg);
            description.velocity = {turned(body.velocity_mps), turned(body.angular_velocity_radps)};
        }
        const Entity entity = add_body(scene_.world(), description, scene_.shapes());
        scene_.body_names.push_back(body.name);
        add_grips(body, shape.frame, entity);
        if (body.kind == BodyKind::kinematic) {
            set_moving(body, entity);
        }
        if (body.visual.empty()) {
            scene_.visuals.push_back({entity, shape_mesh(shape.shape), body.color, {}});
        } else if (const std::optional<GltfLevel> drawn = load(body.visual)) {
            add_visuals(entity, *drawn, inverse(shape.frame));
        }
    }

    // Equal simple shapes share a mesh: a scene may have 100,000 equal links of chains.
    std::shared_ptr<const Mesh> shape_mesh(ShapeId id) {
        const Shape& shape = scene_.shapes().at(id);
        if (shape.hull != nullptr || shape.parts != nullptr || shape.mesh != nullptr) {
            return make_shape_mesh(shape);
        }
        std::shared_ptr<const Mesh>& mesh =
            shape_meshes_[{static_cast<double>(shape.kind), shape.half_m.x(), shape.half_m.y(),
                           shape.half_m.z(), shape.radius_m, shape.half_height_m}];
        if (mesh == nullptr) {
            mesh = make_shape_mesh(shape);
        }
        return mesh;
    }

    void add_grips(const SceneBody& body, const Pose& shape_frame, Entity entity) {
        AuthoredGrips grips;
        for (const SceneGrip& grip : body.grips) {
            grips.grips[grips.count++] = in_body_frame(grip.grip, shape_frame);
        }
        if (!body.grips.empty()) {
            scene_.grips[body.name] = body.grips;
        }
        scene_.body_in_file[body.name] = shape_frame;
        if (grips.count > 0) {
            scene_.world().authored_grips.add(entity, grips);
        }
    }

    void add_scene_joint(const SceneJoint& joint) {
        if (error_ || !take_name(joint.name)) {
            return;
        }
        const auto entity_of = [this](const std::string& name) {
            return name.empty() ? k_no_entity
                                : find_by_id(scene_.world(), persistent_id_from_name(name));
        };
        Joint made = joint.joint;
        made.a = entity_of(joint.a);
        made.b = entity_of(joint.b);
        made.latch.handle = entity_of(joint.handle);
        made = joint_at(scene_.world(), made, file_.world_transform * joint.pose);
        const Vec3 end_ws = transform_point(file_.world_transform, joint.end_a);
        made.frame_a_bs.position =
            is_null(made.a)
                ? end_ws
                : inverse_transform_point(scene_.world().body_pose.at(made.a).pose_ws, end_ws);
        add_joint(scene_.world(), {joint.name, made});
    }

    void set_moving(const SceneBody& body, Entity entity) {
        BodyVelocity& velocity = scene_.world().body_velocity.at(entity);
        if (body.motion.path) {
            std::vector<Pose> poses = body.motion.path->poses;
            for (Pose& pose : poses) {
                pose = file_.world_transform * pose;
            }
            const PathMover mover{make_pose_path(poses, body.motion.path->period_s)};
            scene_.world().path_mover.add(entity, mover);
            const PosePathState state = evaluate(mover.path, 0.0);
            velocity = {state.velocity_mps, state.angular_velocity_radps};
            return;
        }
        const Mover mover{scene_.world().body_pose.at(entity).pose_ws,
                          turned(body.motion.velocity_mps),
                          turned(body.motion.angular_velocity_radps), body.motion.turns_with_body};
        scene_.world().mover.add(entity, mover);
        velocity = {mover.velocity_ws_mps, mover.angular_velocity_ws_radps};
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
        scene_.players.push_back({player.name, from_host(spawn->pose_ws), player.mass_kg});
    }

    const SceneFile& file_;
    const std::filesystem::path& path_;
    const LevelSource& levels_;
    Scene& scene_;
    std::string place_;            // JSON pointer of the element that is being added
    std::set<std::string> names_;  // taken names
    std::map<std::filesystem::path, std::shared_ptr<const Mesh>> meshes_;
    // Key: kind and dimensions of the shape.
    std::map<std::array<double, 6>, std::shared_ptr<const Mesh>> shape_meshes_;
    std::optional<FileError> error_;
};

}  // namespace

std::optional<FileError> add_scene_parts(const SceneFile& file, const std::filesystem::path& path,
                                         const LevelSource& levels, Scene& scene) {
    return SceneBuilder(file, path, levels, scene).build();
}

}  // namespace handhold
