#include "game/levels/robot_scene.hpp"

#include <utility>

#include "game/levels/robot.hpp"
#include "game/mesh/mesh_edit.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

const hh::Vec3 k_left_rail{-0.28, 0.3125, 0.0};   // robot/left; the rail is along z
const hh::Vec3 k_first_rung{0.0, 0.3125, -0.62};  // robot/rung_0; the rung is along x

// All parts of a structure as one collision mesh; the visuals keep their materials.
Mesh whole_mesh(const Structure& structure) {
    Mesh whole;
    for (const Mesh& part : structure.parts) {
        append(whole, part);
    }
    return whole;
}

void add_visuals(const Structure& structure, Entity body, Scene& scene) {
    for (std::size_t i = 0; i < structure.parts.size(); ++i) {
        scene.visuals.push_back({body, std::make_shared<const Mesh>(structure.parts[i]),
                                 std::nullopt, structure.looks[i]});
    }
}

void add_spawns(const Structure& structure, const Pose& at, Scene& scene) {
    for (const SpawnPoint& spawn : structure.spawns) {
        Pose origin = at * spawn.pose;
        origin.position -= origin.rotation * Vec3(0.0, k_eye_height_m, 0.0);
        scene.spawns.push_back({spawn.name, to_host(origin)});
    }
}

Entity add_kinematic(const std::string& name, ShapeId shape, const Pose& pose,
                     const BodyVelocity& velocity, Scene& scene) {
    BodyDescription body;
    body.name = name;
    body.body.kind = BodyKind::kinematic;
    body.pose_ws = pose;
    body.velocity = velocity;
    body.shape = shape;
    scene.body_names.push_back(name);
    return add_body(scene.world(), body, scene.shapes());
}

Entity add_torso(const Structure& torso, const PosePath& path, Scene& scene) {
    const PosePathState start = evaluate(path, 0.0);
    const ShapeId shape = scene.shapes().add_mesh(std::make_shared<const Mesh>(whole_mesh(torso)));
    const Entity entity = add_kinematic("robot", shape, start.pose,
                                        {start.velocity_mps, start.angular_velocity_radps}, scene);
    scene.world().path_mover.add(entity, {path});
    add_visuals(torso, entity, scene);
    return entity;
}

void add_bone(const LegMover& mover, const PosePath& path, const std::string& name, Scene& scene) {
    const bool is_upper = mover.bone == LegBone::upper;
    const double length = is_upper ? mover.leg.upper_m : mover.leg.lower_m;
    const double radius = is_upper ? k_robot_upper_radius_m : k_robot_lower_radius_m;
    const ShapeId shape = scene.shapes().add_capsule(radius, 0.5 * length - radius);
    const Pose pose = crawler_bone_pose(path, mover.gait, mover.leg, mover.bone, 0.0);
    const Entity entity = add_kinematic(name, shape, pose, {}, scene);
    scene.world().leg_mover.add(entity, mover);
    add_visuals(make_robot_bone(mover.leg, mover.bone), entity, scene);
}

}  // namespace

SessionScript robot_script() {
    SessionScript script;
    const hh::Vec3 ahead = -hh::k_z;
    const hh::Vec3 up = hh::k_y;
    script.duration_s = 20.0;
    // The plan: along the left rail from tail to head, then both hands on the first rung while the
    // robot walks into the bend.
    const double height = 0.78;
    script.body = {{0.0, hh::Vec3{-0.10, height, 1.00}, hh::Vec3{}},
                   {0.8, hh::Vec3{-0.10, height, 1.00}, hh::Vec3{}},
                   {1.6, hh::Vec3{-0.10, height, 0.92}, 0.25 * ahead},
                   {6.6, hh::Vec3{-0.10, height, -0.33}, 0.25 * ahead},
                   {7.8, hh::Vec3{-0.02, height, -0.40}, hh::Vec3{}},
                   {20.0, hh::Vec3{-0.02, height, -0.40}, hh::Vec3{}}};
    ScriptedCrawl crawl;
    crawl.bar_start = k_left_rail;
    crawl.along = ahead;
    crawl.away = up;
    crawl.fingers = hh::k_x;
    crawl.from_s = 0.35;
    crawl.until_s = 6.8;
    add_crawl(crawl, script);
    const auto hold = [&](hh::Side side, double from_s, double until_s, double x) {
        script.holds.push_back(
            {side, from_s, until_s, k_first_rung + hh::Vec3{x, 0.02, 0.0}, up, ahead});
    };
    hold(HH_RIGHT, 7.3, 12.0, 0.06);
    hold(HH_LEFT, 8.6, 14.5, -0.07);
    hold(HH_RIGHT, 13.2, 17.6, 0.07);
    hold(HH_LEFT, 15.6, 20.0, -0.06);
    hold(HH_RIGHT, 18.2, 20.0, 0.06);
    return script;
}

Scene make_robot_scene() {
    Scene scene;
    scene.name = "robot";
    scene.description = "a six-legged robot crawls over a hull; climb it while it walks";
    scene.session = SceneSession{{}, scene.name};
    scene.tuning().locomotion.support_follow = SupportFollow::full;

    const Structure hull = make_robot_hull();
    for (std::size_t i = 0; i < hull.parts.size(); ++i) {
        add_static_mesh(scene, hull.parts[i].name, std::make_shared<const Mesh>(hull.parts[i]), {},
                        hull.looks[i]);
    }
    const PosePath path = make_robot_path();
    const Structure torso = make_robot_torso();
    const Entity robot = add_torso(torso, path, scene);
    const std::array<CrawlerLeg, k_robot_legs> legs = robot_legs();
    for (std::size_t i = 0; i < legs.size(); ++i) {
        const std::string name = "robot/leg_" + std::to_string(i);
        add_bone({robot, legs[i], robot_gait(), LegBone::upper}, path, name + "_upper", scene);
        add_bone({robot, legs[i], robot_gait(), LegBone::lower}, path, name + "_lower", scene);
    }
    const PosePathState start = evaluate(path, 0.0);
    scene.world().reference_velocity_mps = start.velocity_mps;
    scene.lamps = torso.lamps;
    scene.lamps_body = robot;
    scene.key = {Vec3(0.55, 0.75, 0.30), {1.15F, 1.10F, 1.02F}, 14.0, 7.0};
    scene.spawns.push_back({"rail", to_host(start.pose) * session_origin(robot_script())});
    add_spawns(torso, start.pose, scene);
    add_spawns(hull, {}, scene);
    return scene;
}

}  // namespace handhold
