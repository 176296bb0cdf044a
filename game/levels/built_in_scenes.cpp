#include "game/levels/built_in_scenes.hpp"

#include <utility>

#include "engine/core/check.hpp"
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
    scene.head_shape = scene.shapes->add_sphere(scene.tuning.head.radius_m);
    scene.session = SceneSession{{}, scene.name};
    return scene;
}

// Adds a structure's spawns. A structure has eye positions; a scene has floor points.
void add_spawns(const Structure& structure, Scene& scene) {
    for (const SpawnPoint& spawn : structure.spawns) {
        Pose origin = spawn.pose;
        origin.position -= origin.rotation * Vec3(0.0, k_eye_height_m, 0.0);
        scene.spawns.push_back({spawn.name, origin});
    }
}

// Adds the rails. All parts share one frame, so the rails can refer to the body of any part.
void add_rails(const std::vector<HandrailSpan>& rails, Scene& scene) {
    for (const HandrailSpan& rail : rails) {
        scene.rails.push_back({scene.visuals.front().body, rail.start, rail.end});
    }
}

// --- station ---

const Vec3 k_hab_rail(-1.033, 0.560, 0.0);  // hab/left_upper; the rail is along z

SessionScript station_script() {
    SessionScript script;
    const Vec3 ahead = -Vec3::UnitZ();
    script.duration_s = 20.5;
    // The plan: along the habitat's rail, hand over hand through the hatch, a push across the node,
    // a catch at the node's far hatch, and a look out of the cupola behind it.
    script.body = {{0.0, Vec3(-0.52, 0.50, 5.60), Vec3::Zero()},
                   {1.0, Vec3(-0.52, 0.50, 5.60), Vec3::Zero()},
                   {2.0, Vec3(-0.52, 0.50, 5.35), 0.5 * ahead},
                   {7.0, Vec3(-0.52, 0.50, 2.85), 0.5 * ahead},
                   {9.2, Vec3(-0.05, 0.34, 2.05), Vec3(0.25, 0.0, -0.35)},
                   {11.0, Vec3(0.02, 0.30, 1.30), 0.7 * ahead},
                   {11.4, Vec3(0.02, 0.30, 0.96), ahead},
                   {11.5, Vec3(0.02, 0.30, 0.86), ahead},
                   {12.9, Vec3(0.02, 0.30, -0.54), ahead},
                   {13.9, Vec3(0.02, 0.34, -0.84), Vec3::Zero()},
                   {15.2, Vec3(0.02, 0.34, -0.84), Vec3::Zero()},
                   {17.6, Vec3(0.02, 0.32, -1.28), Vec3::Zero()},
                   {20.5, Vec3(0.05, 0.34, -1.32), Vec3::Zero()}};
    ScriptedCrawl crawl;
    crawl.bar_start = k_hab_rail;
    crawl.along = ahead;
    crawl.away = Vec3::UnitX();
    crawl.fingers = Vec3::UnitY();
    crawl.from_s = 0.8;
    crawl.until_s = 6.7;
    add_crawl(crawl, script);
    script.holds.push_back(
        {HandSide::left, 7.15, 8.0, Vec3(-1.013, 0.560, 2.58), Vec3::UnitX(), Vec3::UnitY()});
    // Holds on the bar above the habitat's hatch: palms under the bar, fingers forward.
    const Vec3 under = -Vec3::UnitY();
    const auto hold = [&](HandSide side, double from_s, double until_s, const Vec3& on_axis) {
        script.holds.push_back({side, from_s, until_s, on_axis + 0.02 * under, under, ahead});
    };
    hold(HandSide::right, 7.6, 10.1, Vec3(0.16, 0.885, 1.893));
    hold(HandSide::left, 8.7, 9.6, Vec3(-0.18, 0.885, 1.893));
    // The node's hatches have collars instead of bars. The palms first lie under the upper edge of
    // the rear collar, then against the face of the front collar.
    hold(HandSide::left, 10.05, 11.5, Vec3(-0.18, 0.668, 1.235));
    hold(HandSide::right, 10.7, 11.5, Vec3(0.18, 0.668, 1.235));
    const Vec3 back = Vec3::UnitZ();
    const Vec3 collar(0.0, 0.690, -1.211);
    script.holds.push_back(
        {HandSide::right, 12.9, 20.5, collar + Vec3(0.18, 0.0, 0.0), back, Vec3::UnitY()});
    script.holds.push_back(
        {HandSide::left, 13.6, 17.4, collar - Vec3(0.18, 0.0, 0.0), back, Vec3::UnitY()});
    // The eyes follow the hands towards the pane.
    script.reaches.push_back(
        {HandSide::left, 18.6, Vec3(-0.16, -0.06, -1.74), back, Vec3::UnitY()});
    script.reaches.push_back({HandSide::left, 20.5, Vec3(-0.20, 0.00, -1.76), back, Vec3::UnitY()});
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
constexpr double k_first_grip_s = 0.35;       // when the session's first grip begins
constexpr double k_pick_s = 8.6;              // when the session picks up the rock
const Vec3 k_rock_place(-1.10, 0.12, -0.95);  // rock at k_pick_s, in the ship's frame
const Vec3 k_ship_rail(-1.593, 0.530, 0.0);   // ship/wall_upper; the rail is along z
// Approximate x of the wall's face; the session pushes the rock well into the wall.
constexpr double k_ship_wall_x = -1.65;

SessionScript ship_script() {
    SessionScript script;
    script.play_space = rotation_about(
        Vec3::UnitY(), k_half_pi);  // facing the wall (-x); the right hand is towards -z
    script.duration_s = 20.0;
    const Vec3 along = -Vec3::UnitZ();
    script.body = {{0.0, Vec3(-1.02, 0.72, 2.50), Vec3::Zero()},
                   {0.8, Vec3(-1.02, 0.72, 2.50), Vec3::Zero()},
                   {1.6, Vec3(-1.02, 0.72, 2.30), 0.45 * along},
                   {7.0, Vec3(-1.02, 0.72, -0.13), 0.45 * along},
                   {8.0, Vec3(-1.02, 0.72, -0.35), Vec3::Zero()},
                   {20.0, Vec3(-1.02, 0.72, -0.35), Vec3::Zero()}};
    ScriptedCrawl crawl;
    crawl.bar_start = k_ship_rail;
    crawl.along = along;
    crawl.away = Vec3::UnitX();
    crawl.fingers = Vec3::UnitY();
    crawl.from_s = k_first_grip_s;
    crawl.until_s = 6.9;
    add_crawl(crawl, script);
    script.holds.push_back({HandSide::left, 7.2, 15.6, k_ship_rail + Vec3(0.02, 0.0, -0.10),
                            Vec3::UnitX(), Vec3::UnitY()});
    // The hand takes the rock from above, waves it, then pushes it into the wall, which pushes the
    // player back.
    const Vec3 up = Vec3::UnitY();
    const Vec3 fingers = -Vec3::UnitX();
    const Vec3 on_rock = k_rock_place + (k_rock_radius_m + 0.005) * up;
    script.holds.push_back({HandSide::right, k_pick_s, 17.3, on_rock, up, fingers});
    const auto move = [&](double t_s, const Vec3& by, double roll) {
        const Quat turn = rotation_about(Vec3::UnitX(), roll);
        script.reaches.push_back({HandSide::right, t_s, on_rock + by, turn * up, fingers});
    };
    move(9.2, Vec3(0.15, 0.25, 0.10), 0.5);
    move(9.8, Vec3(0.25, 0.10, -0.20), -0.6);
    move(10.4, Vec3(0.05, 0.30, -0.10), 0.7);
    move(11.0, Vec3(0.25, 0.25, 0.15), -0.3);
    move(11.8, Vec3(0.10, 0.35, 0.05), -0.6);
    move(12.6, Vec3(0.30, 0.05, -0.25), 0.8);
    move(13.4, Vec3(0.15, 0.30, 0.20), -0.6);
    move(14.3, Vec3(0.05, 0.15, -0.10), 0.3);
    move(15.2, Vec3(0.20, 0.10, 0.0), 0.0);
    move(16.0, Vec3(0.20, 0.10, 0.0), 0.0);
    move(16.8, Vec3(k_ship_wall_x - k_rock_place.x() - 0.25, 0.10, 0.0), 0.0);
    return script;
}

Scene make_ship_scene() {
    Scene scene = empty_scene(
        "ship", "a shuttle's deck that flies past at 20 m/s and turns: walls, rails and a rock");
    scene.tuning.locomotion.support_follow = SupportFollow::full;
    const Vec3 velocity(0.0, 0.0, -k_ship_speed_mps);
    const Vec3 spin(0.0, k_ship_spin_radps, 0.0);
    scene.world.reference_velocity_mps = velocity;
    Structure ship = make_ship();
    for (std::size_t i = 0; i < ship.parts.size(); ++i) {
        BodyDescription part;
        const std::string name = ship.parts[i].name;
        const auto mesh = std::make_shared<const Mesh>(std::move(ship.parts[i]));
        part.name = name;
        part.body.kind = BodyKind::kinematic;
        part.shape = scene.shapes->add_mesh(mesh);
        part.velocity = {velocity, spin};
        const Entity entity = add_body(scene.world, part, *scene.shapes);
        scene.world.mover.add(entity, {{}, velocity, spin, false});
        scene.body_names.push_back(name);
        scene.visuals.push_back({entity, mesh, std::nullopt, ship.looks[i]});
    }
    BodyDescription rock;
    rock.name = "rock";
    rock.shape = scene.shapes->add_sphere(k_rock_radius_m);
    rock.body = {BodyKind::free, k_rock_mass_kg,
                 solid_inertia(scene.shapes->at(rock.shape), k_rock_mass_kg), 0.3};
    // The rock flies along with the ship but does not turn with it. It starts, relative to the
    // ship's origin, where the turning ship will bring the hand at k_pick_s.
    rock.pose_ws.position = rotation_from_vector(spin * k_pick_s) * k_rock_place;
    rock.velocity = {velocity, Vec3::Zero()};
    const Entity entity = add_body(scene.world, rock, *scene.shapes);
    scene.body_names.emplace_back("rock");
    scene.visuals.push_back(
        {entity, std::make_shared<const Mesh>(make_held_rock()), std::nullopt, {}});
    scene.lamps = ship.lamps;
    scene.lamps_body = scene.world.mover.owners()[0];
    // A player who holds nothing does not turn with the ship. The spawn is chosen so that at
    // k_first_grip_s the turning ship is in the right place for the first grip.
    const Pose turned{Vec3::Zero(), rotation_from_vector(spin * k_first_grip_s)};
    scene.spawns.push_back({"rail", turned * session_origin(ship_script())});
    add_spawns(ship, scene);
    add_rails(ship.rails, scene);
    return scene;
}

// --- crowd ---

// The first player plays the station's session.
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
    return std::nullopt;
}

}  // namespace

std::vector<std::string_view> built_in_scenes() {
    return {"station", "ship", "playground", "robot", "crowd", "reach", "together"};
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
    scene.spawns.insert(scene.spawns.begin(), {"rail", session_origin(station_script())});
}

std::optional<Recording> make_built_in_session(std::string_view name) {
    const HandTuning tuning;
    if (name == "station" || name == "crowd") {
        return record_session(station_script(), tuning);
    }
    if (name == "ship") {
        return record_session(ship_script(), tuning);
    }
    if (name == "playground") {
        return record_session(playground_script(), tuning);
    }
    if (name == "robot") {
        return record_session(robot_script(), tuning);
    }
    if (name == "reach") {
        return record_session(reach_script(), tuning);
    }
    if (name == "together") {
        return record_session(together_script(), tuning);
    }
    return std::nullopt;
}

std::vector<Recording> make_built_in_partners(std::string_view name) {
    std::vector<Recording> partners;
    if (name == "together") {
        partners.push_back(record_session(together_partner_script(), HandTuning()));
    }
    return partners;
}

}  // namespace handhold
