#include "game/levels/built_in_scenes.hpp"

#include <utility>

#include "engine/core/check.hpp"
#include "game/levels/arena_scene.hpp"
#include "game/levels/crowd_scene.hpp"
#include "game/levels/playground.hpp"
#include "game/levels/reach.hpp"
#include "game/levels/robot_scene.hpp"
#include "game/levels/station.hpp"
#include "game/levels/station_scene.hpp"
#include "game/levels/together.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/session/session_script.hpp"

namespace handhold {
namespace {

Scene empty_scene(std::string name, std::string description) {
    Scene scene;
    scene.name = std::move(name);
    scene.description = std::move(description);
    scene.session = SceneSession{{}, scene.name};
    return scene;
}

// Adds a structure's spawns. A structure has eye positions; a scene has floor points.
void add_spawns(const Structure& structure, Scene& scene) {
    for (const SpawnPoint& spawn : structure.spawns) {
        Pose origin = spawn.pose;
        origin.position -= origin.rotation * Vec3(0.0, k_eye_height_m, 0.0);
        scene.spawns.push_back({spawn.name, to_host(origin)});
    }
}

// Adds the rails. All parts share one frame, so the rails can refer to the body of any part.
void add_rails(const std::vector<HandrailSpan>& rails, Scene& scene) {
    for (const HandrailSpan& rail : rails) {
        scene.rails.push_back(
            {body_id(scene.visuals.front().body), to_host(rail.start), to_host(rail.end)});
    }
}

// --- station ---

const hh::Vec3 k_hab_rail{-1.033, 0.560, 0.0};  // hab/left_upper; the rail is along z

SessionScript station_script() {
    SessionScript script;
    const hh::Vec3 ahead = -hh::k_z;
    script.duration_s = 20.5;
    // The plan: the player moves hand over hand along the habitat's rail and through the hatch,
    // pushes off across the node, catches the node's far hatch, and looks out of the cupola behind
    // it.
    script.body = {{0.0, hh::Vec3{-0.52, 0.50, 5.60}, hh::Vec3{}},
                   {1.0, hh::Vec3{-0.52, 0.50, 5.60}, hh::Vec3{}},
                   {2.0, hh::Vec3{-0.52, 0.50, 5.35}, 0.5 * ahead},
                   {7.0, hh::Vec3{-0.52, 0.50, 2.85}, 0.5 * ahead},
                   {9.2, hh::Vec3{-0.05, 0.34, 2.05}, hh::Vec3{0.25, 0.0, -0.35}},
                   {11.0, hh::Vec3{0.02, 0.30, 1.30}, 0.7 * ahead},
                   {11.4, hh::Vec3{0.02, 0.30, 0.96}, ahead},
                   {11.5, hh::Vec3{0.02, 0.30, 0.86}, ahead},
                   {12.9, hh::Vec3{0.02, 0.30, -0.54}, ahead},
                   {13.9, hh::Vec3{0.02, 0.34, -0.84}, hh::Vec3{}},
                   {15.2, hh::Vec3{0.02, 0.34, -0.84}, hh::Vec3{}},
                   {17.6, hh::Vec3{0.02, 0.32, -1.28}, hh::Vec3{}},
                   {20.5, hh::Vec3{0.05, 0.34, -1.32}, hh::Vec3{}}};
    ScriptedCrawl crawl;
    crawl.bar_start = k_hab_rail;
    crawl.along = ahead;
    crawl.away = hh::k_x;
    crawl.fingers = hh::k_y;
    crawl.from_s = 0.8;
    crawl.until_s = 6.7;
    add_crawl(crawl, script);
    script.holds.push_back({HH_LEFT, 7.15, 8.0, hh::Vec3{-1.013, 0.560, 2.58}, hh::k_x, hh::k_y});
    // Holds on the bar above the habitat's hatch: palms under the bar, fingers forward.
    const hh::Vec3 under = -hh::k_y;
    const auto hold = [&](hh::Side side, double from_s, double until_s, const hh::Vec3& on_axis) {
        script.holds.push_back({side, from_s, until_s, on_axis + 0.02 * under, under, ahead});
    };
    hold(HH_RIGHT, 7.6, 10.1, hh::Vec3{0.16, 0.885, 1.893});
    hold(HH_LEFT, 8.7, 9.6, hh::Vec3{-0.18, 0.885, 1.893});
    // The node's hatches have collars instead of bars. The palms first lie under the upper edge of
    // the rear collar, then against the face of the front collar.
    hold(HH_LEFT, 10.05, 11.5, hh::Vec3{-0.18, 0.668, 1.235});
    hold(HH_RIGHT, 10.7, 11.5, hh::Vec3{0.18, 0.668, 1.235});
    const hh::Vec3 back = hh::k_z;
    const hh::Vec3 collar{0.0, 0.690, -1.211};
    script.holds.push_back(
        {HH_RIGHT, 12.9, 20.5, collar + hh::Vec3{0.18, 0.0, 0.0}, back, hh::k_y});
    script.holds.push_back({HH_LEFT, 13.6, 17.4, collar - hh::Vec3{0.18, 0.0, 0.0}, back, hh::k_y});
    // The eyes follow the hands towards the pane.
    script.reaches.push_back({HH_LEFT, 18.6, hh::Vec3{-0.16, -0.06, -1.74}, back, hh::k_y});
    script.reaches.push_back({HH_LEFT, 20.5, hh::Vec3{-0.20, 0.00, -1.76}, back, hh::k_y});
    return script;
}

// Built from the description that is compiled into the game; reads no file.
Scene make_station_scene() {
    StationScene station = make_station_scene(own_station_description());
    add_session_spawn(station.scene);
    const auto find_model = [&station](const std::filesystem::path& file) -> Result<GltfLevel> {
        for (const StationModel& model : station.models) {
            if (model.file == file) {
                return level_of(model.structure);
            }
        }
        return FileError{file.string(), "", "expected one of the station's models"};
    };
    Result<Scene> scene = build_scene(station.scene, "station.json", find_model);
    HH_CHECK(scene.ok(), "the game's own station is refused", station.models.size());
    add_rails(station_rails(), scene.value());
    return std::move(scene.value());
}

// --- ship ---

constexpr double k_ship_speed_mps = 20.0;
constexpr double k_ship_spin_radps = 0.06;
constexpr double k_rock_radius_m = 0.08;
constexpr double k_rock_mass_kg = 5.0;
constexpr double k_first_grip_s = 0.35;           // when the session's first grip begins
constexpr double k_pick_s = 8.6;                  // when the session picks up the rock
const hh::Vec3 k_rock_place{-1.10, 0.12, -0.95};  // rock at k_pick_s, in the ship's frame
const hh::Vec3 k_ship_rail{-1.593, 0.530, 0.0};   // ship/wall_upper; the rail is along z
// Approximate x of the wall's face; the session pushes the rock well into the wall.
constexpr double k_ship_wall_x = -1.65;

SessionScript ship_script() {
    SessionScript script;
    script.play_space = hh::rotation_about(
        hh::k_y, k_half_pi);  // facing the wall (-x); the right hand is towards -z
    script.duration_s = 20.0;
    const hh::Vec3 along = -hh::k_z;
    script.body = {{0.0, hh::Vec3{-1.02, 0.72, 2.50}, hh::Vec3{}},
                   {0.8, hh::Vec3{-1.02, 0.72, 2.50}, hh::Vec3{}},
                   {1.6, hh::Vec3{-1.02, 0.72, 2.30}, 0.45 * along},
                   {7.0, hh::Vec3{-1.02, 0.72, -0.13}, 0.45 * along},
                   {8.0, hh::Vec3{-1.02, 0.72, -0.35}, hh::Vec3{}},
                   {20.0, hh::Vec3{-1.02, 0.72, -0.35}, hh::Vec3{}}};
    ScriptedCrawl crawl;
    crawl.bar_start = k_ship_rail;
    crawl.along = along;
    crawl.away = hh::k_x;
    crawl.fingers = hh::k_y;
    crawl.from_s = k_first_grip_s;
    crawl.until_s = 6.9;
    add_crawl(crawl, script);
    script.holds.push_back(
        {HH_LEFT, 7.2, 15.6, k_ship_rail + hh::Vec3{0.02, 0.0, -0.10}, hh::k_x, hh::k_y});
    // The hand takes the rock from above, waves it, then pushes it into the wall, which pushes the
    // player back.
    const hh::Vec3 up = hh::k_y;
    const hh::Vec3 fingers = -hh::k_x;
    const hh::Vec3 on_rock = k_rock_place + (k_rock_radius_m + 0.005) * up;
    script.holds.push_back({HH_RIGHT, k_pick_s, 17.3, on_rock, up, fingers});
    const auto move = [&](double t_s, const hh::Vec3& by, double roll) {
        const hh::Quat turn = hh::rotation_about(hh::k_x, roll);
        script.reaches.push_back({HH_RIGHT, t_s, on_rock + by, turn * up, fingers});
    };
    move(9.2, hh::Vec3{0.15, 0.25, 0.10}, 0.5);
    move(9.8, hh::Vec3{0.25, 0.10, -0.20}, -0.6);
    move(10.4, hh::Vec3{0.05, 0.30, -0.10}, 0.7);
    move(11.0, hh::Vec3{0.25, 0.25, 0.15}, -0.3);
    move(11.8, hh::Vec3{0.10, 0.35, 0.05}, -0.6);
    move(12.6, hh::Vec3{0.30, 0.05, -0.25}, 0.8);
    move(13.4, hh::Vec3{0.15, 0.30, 0.20}, -0.6);
    move(14.3, hh::Vec3{0.05, 0.15, -0.10}, 0.3);
    move(15.2, hh::Vec3{0.20, 0.10, 0.0}, 0.0);
    move(16.0, hh::Vec3{0.20, 0.10, 0.0}, 0.0);
    move(16.8, hh::Vec3{k_ship_wall_x - k_rock_place.x - 0.25, 0.10, 0.0}, 0.0);
    return script;
}

Scene make_ship_scene() {
    Scene scene = empty_scene(
        "ship", "a shuttle's deck that flies past at 20 m/s and turns: walls, rails and a rock");
    scene.tuning().locomotion.support_follow = SupportFollow::full;
    const Vec3 velocity(0.0, 0.0, -k_ship_speed_mps);
    const Vec3 spin(0.0, k_ship_spin_radps, 0.0);
    scene.world().reference_velocity_mps = velocity;
    Structure ship = make_ship();
    for (std::size_t i = 0; i < ship.parts.size(); ++i) {
        BodyDescription part;
        const std::string name = ship.parts[i].name;
        const auto mesh = std::make_shared<const Mesh>(std::move(ship.parts[i]));
        part.name = name;
        part.body.kind = BodyKind::kinematic;
        part.shape = scene.shapes().add_mesh(mesh);
        part.velocity = {velocity, spin};
        const Entity entity = add_body(scene.world(), part, scene.shapes());
        scene.world().mover.add(entity, {{}, velocity, spin, false});
        scene.body_names.push_back(name);
        scene.visuals.push_back({entity, mesh, std::nullopt, ship.looks[i]});
    }
    BodyDescription rock;
    rock.name = "rock";
    rock.shape = scene.shapes().add_sphere(k_rock_radius_m);
    rock.body = {BodyKind::free, k_rock_mass_kg,
                 solid_inertia(scene.shapes().at(rock.shape), k_rock_mass_kg), 0.3};
    // The rock flies along with the ship but does not turn with it. It starts, relative to the
    // ship's origin, where the turning ship will bring the hand at k_pick_s.
    rock.pose_ws.position = rotation_from_vector(spin * k_pick_s) * from_host(k_rock_place);
    rock.velocity = {velocity, Vec3::Zero()};
    const Entity entity = add_body(scene.world(), rock, scene.shapes());
    scene.body_names.emplace_back("rock");
    scene.visuals.push_back(
        {entity, std::make_shared<const Mesh>(make_held_rock()), std::nullopt, {}});
    scene.lamps = ship.lamps;
    scene.lamps_body = scene.world().mover.owners()[0];
    // A player who holds nothing does not turn with the ship. The spawn is chosen so that at
    // k_first_grip_s the turning ship is in the right place for the first grip.
    const Pose turned{Vec3::Zero(), rotation_from_vector(spin * k_first_grip_s)};
    scene.spawns.push_back({"rail", to_host(turned * from_host(session_origin(ship_script())))});
    add_spawns(ship, scene);
    add_rails(ship.rails, scene);
    return scene;
}

// --- crowd ---

// The first player replays the station's session: make_built_in_session returns the same recording
// for "crowd" and "station".
Scene make_crowd_scene() {
    Scene scene = make_station_scene();
    scene.name = "crowd";
    scene.description = "the station with a dozen scripted climbers and free bodies";
    scene.session = SceneSession{{}, scene.name};
    fill_with_crowd(scene);
    return scene;
}

std::optional<Scene> make_bodies_of(std::string_view name) {
    if (name == "station") {
        return make_station_scene();
    }
    if (name == "ship") {
        return make_ship_scene();
    }
    if (name == "playground") {
        return make_playground_scene();
    }
    if (name == "robot") {
        return make_robot_scene();
    }
    if (name == "reach") {
        return make_reach_scene();
    }
    if (name == "crowd") {
        return make_crowd_scene();
    }
    if (name == "together") {
        return make_together_scene();
    }
    if (name == "arena") {
        return make_arena_scene();
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::string_view> built_in_scenes() {
    return {"station", "ship", "playground", "robot", "crowd", "reach", "together", "arena"};
}

std::optional<Scene> make_built_in_scene(std::string_view name) {
    std::optional<Scene> scene = make_bodies_of(name);
    if (scene) {
        add_grip_meshes(*scene);
    }
    return scene;
}

void add_session_spawn(SceneFile& scene) {
    if (!scene.session || scene.session->built_in != "station") {
        return;
    }
    scene.spawns.insert(scene.spawns.begin(),
                        {"rail", from_host(session_origin(station_script()))});
}

std::optional<Recording> make_built_in_session(std::string_view name) {
    const HandShape hands = hand_shape(hh::World());
    if (name == "station" || name == "crowd") {
        return record_session(station_script(), hands);
    }
    if (name == "ship") {
        return record_session(ship_script(), hands);
    }
    if (name == "playground") {
        return record_session(playground_script(), hands);
    }
    if (name == "robot") {
        return record_session(robot_script(), hands);
    }
    if (name == "reach") {
        return record_session(reach_script(), hands);
    }
    if (name == "together") {
        return record_session(together_script(), hands);
    }
    return std::nullopt;
}

std::vector<Recording> make_built_in_partners(std::string_view name) {
    std::vector<Recording> partners;
    if (name == "together") {
        partners.push_back(record_session(together_partner_script(), hand_shape(hh::World())));
    }
    return partners;
}

}  // namespace handhold
