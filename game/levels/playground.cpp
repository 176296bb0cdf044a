#include "game/levels/playground.hpp"

#include <utility>

#include "engine/core/check.hpp"
#include "game/assets/assets.hpp"
#include "game/levels/gun.hpp"
#include "game/levels/station_scene.hpp"

namespace handhold {
namespace {

const hh::Vec3 k_rail{0.0, 0.98, 0.16};  // point on the rail's axis, which is along x
constexpr double k_eyes_y_m = 1.48;
constexpr double k_eyes_z_m = 0.62;
constexpr double k_crawl_mps = 0.55;
constexpr const char* k_gun_model = "gun.glb";  // built in code, not loaded

// The gun's pose: to the right of the session's start, with the muzzle to the left.
hh::Pose gun_place() { return {hh::Vec3{-3.02, 1.31, 0.45}, hh::rotation_about(hh::k_y, 1.05)}; }

hh::Vec3 eyes_before(double x_m, double z_m = k_eyes_z_m) { return {x_m, k_eyes_y_m, z_m}; }

// The left hand holds the rail while the right hand works.
void stay(double from_s, double until_s, double x_m, SessionScript& script) {
    script.holds.push_back(
        {HH_LEFT, from_s, until_s, k_rail + hh::Vec3{x_m, 0.0, 0.02}, hh::k_z, hh::k_y});
}

// Moves hand over hand along the rail to the next contraption.
void crawl(double from_s, double from_x_m, double to_x_m, SessionScript& script) {
    const double until_s = from_s + (to_x_m - from_x_m) / k_crawl_mps;
    const hh::Vec3 along = hh::k_x;
    script.body.push_back({from_s, eyes_before(from_x_m), hh::Vec3{}});
    script.body.push_back({from_s + 0.4, eyes_before(from_x_m + 0.2), k_crawl_mps * along});
    script.body.push_back({until_s - 0.4, eyes_before(to_x_m - 0.2), k_crawl_mps * along});
    script.body.push_back({until_s, eyes_before(to_x_m), hh::Vec3{}});
    ScriptedCrawl hands;
    hands.bar_start = k_rail;
    hands.along = along;
    hands.away = hh::k_z;
    hands.fingers = hh::k_y;
    hands.from_s = from_s;
    hands.until_s = until_s;
    add_crawl(hands, script);
}

// A grab by the right hand and the motions that follow.
struct Work {
    SessionScript& script;
    double from_s;
    hh::Vec3 palm{};
    hh::Vec3 away{};
    hh::Vec3 fingers{};

    void hold(double until_s) const {
        script.holds.push_back({HH_RIGHT, from_s, until_s, palm, away, fingers});
    }
    void move(double t_s, const hh::Vec3& by) const {
        script.reaches.push_back({HH_RIGHT, t_s, palm + by, away, fingers});
    }
    // Turns the hand about `pivot`, as a part of a rotating body would move it.
    void turn(double t_s, const hh::Vec3& pivot, const hh::Vec3& axis, double angle_rad) const {
        const hh::Quat turned = hh::rotation_about(axis, angle_rad);
        script.reaches.push_back(
            {HH_RIGHT, t_s, pivot + turned * (palm - pivot), turned * away, turned * fingers});
    }
};

void work_lever(double t_s, SessionScript& script) {
    const Work lever{script, t_s, hh::Vec3{-3.4, 1.674, 0.13}, hh::k_y, -hh::k_z};
    const hh::Vec3 pivot{-3.4, 1.36, 0.13};
    lever.hold(t_s + 2.4);
    lever.turn(t_s + 0.3, pivot, hh::k_x, 0.0);
    lever.turn(t_s + 1.1, pivot, hh::k_x, 1.0);
    lever.turn(t_s + 1.4, pivot, hh::k_x, 1.0);
    lever.turn(t_s + 2.2, pivot, hh::k_x, 0.2);
}

void work_drawer(double t_s, SessionScript& script) {
    const Work drawer{script, t_s, hh::Vec3{-1.75, 1.5, 0.414}, hh::k_z, hh::k_y};
    drawer.hold(t_s + 2.6);
    drawer.move(t_s + 0.3, hh::Vec3{});
    drawer.move(t_s + 1.2, hh::Vec3{0.0, 0.0, 0.20});
    drawer.move(t_s + 1.6, hh::Vec3{0.0, 0.0, 0.20});
    drawer.move(t_s + 2.4, hh::Vec3{0.0, 0.0, 0.06});
}

// The right hand turns the door's handle down, pulls the door open, and lets the handle return.
void work_door(double t_s, SessionScript& script) {
    const Work handle{script, t_s, hh::Vec3{-0.06, 1.5, 0.345}, hh::k_z, -hh::k_y};
    const hh::Vec3 pivot{0.02, 1.5, 0.345};
    const hh::Vec3 hinge{-0.485, 1.5, 0.272};
    handle.hold(t_s + 3.4);
    handle.turn(t_s + 0.3, pivot, hh::k_z, 0.0);
    // A positive angle about +z lowers the handle's free end, which is on its -x side.
    handle.turn(t_s + 0.9, pivot, hh::k_z, 0.7);
    const hh::Quat down = hh::rotation_about(hh::k_z, 0.7);
    const hh::Vec3 palm = pivot + down * (handle.palm - pivot);
    for (int i = 1; i <= 4; ++i) {
        const hh::Quat open = hh::rotation_about(hh::k_y, -0.3 * i);
        script.reaches.push_back({HH_RIGHT, t_s + 0.9 + 0.5 * i, hinge + open * (palm - hinge),
                                  open * down * handle.away, open * down * handle.fingers});
    }
}

void work_valve(double t_s, SessionScript& script) {
    const hh::Vec3 hub{1.3, 1.5, 0.23};
    const Work rim{script, t_s, hub + hh::Vec3{0.17, 0.0, 0.018}, hh::k_z, -hh::k_x};
    rim.hold(t_s + 2.6);
    for (int i = 0; i <= 6; ++i) {
        rim.turn(t_s + 0.3 + 0.35 * i, hub, hh::k_z, 0.3 * i);
    }
}

void work_cable(double t_s, SessionScript& script) {
    const Work link{script, t_s, hh::Vec3{2.75, 1.25, 0.317}, hh::k_z, hh::k_x};
    link.hold(t_s + 3.4);
    link.move(t_s + 0.3, hh::Vec3{});
    link.move(t_s + 1.1, hh::Vec3{0.25, 0.10, -0.03});
    link.move(t_s + 1.9, hh::Vec3{-0.30, 0.10, -0.03});
    link.move(t_s + 2.6, hh::Vec3{0.20, 0.15, -0.03});
    link.move(t_s + 3.2, hh::Vec3{0.05, 0.05, -0.03});
}

// The right hand pushes a rock into a narrower gap, which pushes the player back.
void work_rock(double t_s, SessionScript& script) {
    const Work rock{script, t_s, hh::Vec3{3.42, 1.62, 0.505}, hh::k_z, hh::k_y};
    rock.hold(t_s + 3.6);
    rock.move(t_s + 0.4, hh::Vec3{});
    rock.move(t_s + 1.2, hh::Vec3{0.33, -0.12, 0.12});
    rock.move(t_s + 2.0, hh::Vec3{0.33, -0.12, -0.12});
    rock.move(t_s + 2.6, hh::Vec3{0.33, -0.12, -0.12});
    rock.move(t_s + 3.4, hh::Vec3{0.0, 0.05, 0.20});
}

// A wrist pose in the form that scripts use.
struct ScriptedWrist {
    hh::Vec3 palm, away, fingers;
};
ScriptedWrist scripted_wrist(const hh::Pose& wrist) {
    return {hh::transform_point(wrist, to_host(HandTuning().palm_center_m)),
            wrist.rotation * hh::k_y, wrist.rotation * -hh::k_z};
}

// The right hand takes the gun by its handle, aims, returns the gun, and takes it again by its
// back, where no authored grip is near.
void work_gun(double t_s, SessionScript& script) {
    const GunModel gun = make_gun();
    const hh::Pose wrist_in_gun = to_host(gun.grips.front().grip.hands[HH_RIGHT].wrist_bs);
    const hh::Pose beside{hh::Vec3{0.020, -0.012, 0.015}, hh::rotation_about(hh::k_z, 0.25)};
    const hh::Pose back = gun_place() * wrist_in_gun * beside;
    const ScriptedWrist closed = scripted_wrist(back);
    script.holds.push_back({HH_RIGHT, t_s, t_s + 5.0, closed.palm, closed.away, closed.fingers});
    const auto aim = [&](double at_s, const hh::Vec3& place, double yaw_rad, double pitch_rad) {
        const hh::Pose gun_ws{
            place, hh::rotation_about(hh::k_y, yaw_rad) * hh::rotation_about(hh::k_x, pitch_rad)};
        const ScriptedWrist wrist = scripted_wrist(gun_ws * wrist_in_gun);
        script.reaches.push_back({HH_RIGHT, at_s, wrist.palm, wrist.away, wrist.fingers});
    };
    script.reaches.push_back({HH_RIGHT, t_s + 0.4, closed.palm, closed.away, closed.fingers});
    aim(t_s + 1.3, hh::Vec3{-3.25, 1.38, 0.44}, 0.9, 0.35);
    aim(t_s + 2.1, hh::Vec3{-3.20, 1.40, 0.46}, 0.5, 0.75);
    aim(t_s + 2.5, hh::Vec3{-3.20, 1.40, 0.46}, 0.5, 0.75);
    aim(t_s + 3.4, hh::Vec3{-3.10, 1.38, 0.50}, -0.8, 0.2);
    script.presses.push_back({HH_RIGHT, t_s + 2.0, t_s + 2.6});
    // After the release, the gun stays where the hand held it.
    const hh::Pose left_at = back * hh::inverse(wrist_in_gun);
    const hh::Pose on_back{hh::transform_point(left_at, hh::Vec3{0.0, 0.076, -0.085}),
                           left_at.rotation * hh::rotation_about(hh::k_y, 1.2)};
    const hh::Vec3 up = on_back.rotation * hh::k_y;
    const hh::Vec3 fingers = on_back.rotation * -hh::k_z;
    script.holds.push_back({HH_RIGHT, t_s + 6.0, t_s + 7.2, on_back.position, up, fingers});
    script.reaches.push_back(
        {HH_RIGHT, t_s + 6.6, on_back.position + hh::Vec3{0.05, 0.08, 0.05}, up, fingers});
}

}  // namespace

Scene make_playground_scene() {
    Result<SceneFile> file = parse_scene_file(game_asset("playground.json"), "playground.json");
    HH_CHECK(static_cast<bool>(file), "the playground's description is broken", 0);
    GunModel gun = make_gun();
    SceneBody body;
    body.name = "gun";
    body.kind = BodyKind::free;
    body.shape = std::move(gun.shape);
    body.pose = from_host(gun_place());
    body.mass_kg = gun.mass_kg;
    body.restitution = 0.2;
    body.visual = k_gun_model;
    body.grips = gun.grips;
    file.value().bodies.push_back(std::move(body));
    const auto models = [&gun](const std::filesystem::path& model) -> Result<GltfLevel> {
        if (model != k_gun_model) {
            return FileError{model.string(), "", "expected the playground's only model, the gun"};
        }
        return level_of(gun.visual);
    };
    Result<Scene> scene = build_scene(file.value(), "playground.json", models);
    HH_CHECK(static_cast<bool>(scene), "the playground's description is broken", 0);
    scene.value().lamps = {{Vec3(-3.0, 2.5, 1.6), {2.6F, 2.5F, 2.4F}, 5.0},
                           {Vec3(0.0, 2.5, 1.6), {2.6F, 2.5F, 2.4F}, 5.0},
                           {Vec3(3.0, 2.5, 1.6), {2.6F, 2.5F, 2.4F}, 5.0}};
    return std::move(scene.value());
}

SessionScript playground_script() {
    SessionScript script;
    // Duration of the gun's part, which comes before the other contraptions.
    constexpr double k_gun_s = 8.2;
    script.body.push_back({0.0, eyes_before(-3.4), hh::Vec3{}});
    stay(0.4, k_gun_s + 4.4, -3.65, script);
    work_gun(1.2, script);
    work_lever(k_gun_s + 1.2, script);
    crawl(k_gun_s + 4.6, -3.4, -1.75, script);
    stay(k_gun_s + 7.7, k_gun_s + 11.3, -2.0, script);
    work_drawer(k_gun_s + 8.2, script);
    crawl(k_gun_s + 11.4, -1.75, -0.2, script);
    stay(k_gun_s + 14.3, k_gun_s + 18.6, -0.5, script);
    work_door(k_gun_s + 14.8, script);
    crawl(k_gun_s + 18.8, -0.2, 1.3, script);
    stay(k_gun_s + 21.6, k_gun_s + 25.0, 1.0, script);
    work_valve(k_gun_s + 22.0, script);
    crawl(k_gun_s + 25.2, 1.3, 2.45, script);
    stay(k_gun_s + 27.4, k_gun_s + 31.2, 2.2, script);
    work_cable(k_gun_s + 27.7, script);
    crawl(k_gun_s + 31.3, 2.45, 3.45, script);
    stay(k_gun_s + 33.2, k_gun_s + 34.4, 3.2, script);
    work_rock(k_gun_s + 33.5, script);
    script.duration_s = k_gun_s + 38.0;
    return script;
}

}  // namespace handhold
