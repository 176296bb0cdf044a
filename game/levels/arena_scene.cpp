#include "game/levels/arena_scene.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <handhold/math.hpp>

#include "game/arena/arena_game.hpp"
#include "game/levels/arena.hpp"
#include "game/mesh/mesh_edit.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

constexpr double k_disc_mass_kg = 0.6;
constexpr int k_arena_climbers = 7;
constexpr double k_arena_jets_mps2 = 4.0;

void add_visuals_of(const Structure& structure, Entity body, Scene& scene) {
    for (std::size_t i = 0; i < structure.parts.size(); ++i) {
        scene.visuals.push_back({body, std::make_shared<const Mesh>(structure.parts[i]),
                                 std::nullopt, structure.looks[i]});
    }
}

void add_rails_of(const Structure& structure, Entity body, Scene& scene) {
    for (const HandrailSpan& rail : structure.rails) {
        scene.rails.push_back({body_id(body), to_host(rail.start), to_host(rail.end)});
    }
}

void add_hall(Scene& scene) {
    const Structure hall = make_arena_hall();
    Entity first = k_no_entity;
    for (std::size_t i = 0; i < hall.parts.size(); ++i) {
        const Entity body =
            add_static_mesh(scene, hall.parts[i].name, std::make_shared<const Mesh>(hall.parts[i]),
                            {}, hall.looks[i]);
        first = is_null(first) ? body : first;
    }
    add_rails_of(hall, first, scene);
    scene.lamps = hall.lamps;
}

// Oscillates across the hall on a flat oval.
void add_platform(Scene& scene, const std::string& name, double sign) {
    std::array<Pose, 4> poses;
    const std::array<Vec3, 4> places = {Vec3(-3.2, 0.0, 0.0), Vec3(0.0, -1.2, 0.8),
                                        Vec3(3.2, 0.0, 0.0), Vec3(0.0, 1.2, -0.8)};
    for (std::size_t i = 0; i < places.size(); ++i) {
        poses[i].position = sign * places[i] + Vec3(0.0, sign * -0.6, sign * 6.5);
    }
    const PosePath path = make_pose_path(poses, 16.0);
    const PosePathState start = evaluate(path, 0.0);
    const Structure platform = make_arena_platform();
    Mesh whole;
    for (const Mesh& part : platform.parts) {
        append(whole, part);
    }
    BodyDescription body;
    body.name = name;
    body.body.kind = BodyKind::kinematic;
    body.pose_ws = start.pose;
    body.velocity = {start.velocity_mps, start.angular_velocity_radps};
    body.shape = scene.shapes().add_mesh(std::make_shared<const Mesh>(std::move(whole)));
    scene.body_names.push_back(name);
    const Entity entity = add_body(scene.world(), body, scene.shapes());
    scene.world().path_mover.add(entity, {path});
    add_visuals_of(platform, entity, scene);
    add_rails_of(platform, entity, scene);
}

hh::Body add_disc(Scene& scene) {
    BodyDescription body;
    body.name = "disc";
    body.shape = scene.shapes().add_cylinder(k_disc_radius_m, k_disc_half_height_m);
    body.body = {BodyKind::free, k_disc_mass_kg,
                 solid_inertia(scene.shapes().at(body.shape), k_disc_mass_kg), 0.7};
    const Entity entity = add_body(scene.world(), body, scene.shapes());
    scene.body_names.emplace_back("disc");
    add_visuals_of(make_arena_disc(), entity, scene);
    return body_id(entity);
}

// Both teams' scores above a goal; blue is on the left. The drums look through the wall.
void add_board(Scene& scene, double sign, ArenaPlan& plan) {
    const double facing_rad = sign > 0.0 ? k_pi : 0.0;
    constexpr std::array<double, 4> k_x = {-1.45, -0.65, 0.65, 1.45};
    for (std::size_t i = 0; i < k_x.size(); ++i) {
        ArenaDrum drum;
        drum.team = i < 2 ? ArenaTeam::blue : ArenaTeam::orange;
        drum.divisor = i % 2 == 0 ? 10 : 1;
        drum.facing_rad = facing_rad;
        drum.center_ws = {-sign * k_x[i], 3.3,
                          sign * (k_arena_half_length_m - 0.15 + k_drum_face_m)};
        BodyDescription body;
        const std::string name =
            std::string(sign > 0.0 ? "blue_end" : "orange_end") + "/digit_" + std::to_string(i);
        body.name = name;
        body.body.kind = BodyKind::kinematic;
        body.shape = k_no_shape;
        body.pose_ws = from_host(drum_pose(drum, 0));
        const Entity entity = add_body(scene.world(), body, scene.shapes());
        scene.body_names.push_back(name);
        const Color color =
            drum.team == ArenaTeam::blue ? Color{0.05F, 0.25F, 1.0F} : Color{1.0F, 0.25F, 0.02F};
        add_visuals_of(make_score_drum(color), entity, scene);
        drum.body = body_id(entity);
        plan.drums.push_back(drum);
    }
}

void add_team_spawns(Scene& scene) {
    constexpr std::array<std::array<double, 2>, 4> k_team_places = {
        {{0.0, 0.0}, {2.2, 0.8}, {-2.2, -0.8}, {0.4, -2.4}}};
    for (std::size_t i = 0; i < k_team_places.size(); ++i) {
        for (const double sign : {1.0, -1.0}) {
            const hh::Quat turn = hh::rotation_about(hh::k_y, sign > 0.0 ? 0.0 : k_pi);
            const hh::Vec3 eyes{sign * k_team_places[i][0], k_team_places[i][1], sign * 13.5};
            scene.spawns.push_back(
                {std::string(sign > 0.0 ? "blue" : "orange") + std::to_string(i + 1),
                 {eyes - hh::Vec3{0.0, k_eye_height_m, 0.0}, turn}});
        }
    }
}

}  // namespace

Scene make_arena_scene() {
    Scene scene;
    scene.name = "arena";
    scene.description = "two teams, two goals and a disc in a round hall of 40 m";
    scene.climbers = k_arena_climbers;
    scene.tuning().locomotion.thruster_mps2 = k_arena_jets_mps2;
    add_hall(scene);
    add_platform(scene, "platform_blue", 1.0);
    add_platform(scene, "platform_orange", -1.0);
    scene.arena.emplace();
    scene.arena->plan.disc = add_disc(scene);
    add_board(scene, 1.0, scene.arena->plan);
    add_board(scene, -1.0, scene.arena->plan);
    add_team_spawns(scene);
    return scene;
}

}  // namespace handhold
