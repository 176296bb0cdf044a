#include "tools/lab/match_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "components/player.hpp"

namespace handhold::lab {
namespace {

constexpr double k_between_m = 2.0;  // neighbours of "crawl", pairs of "bars"
constexpr double k_bar_height_m = 1.2;
constexpr double k_away_from_bar_m = 0.9;

std::string name_of_player(std::size_t player) { return "player" + std::to_string(player); }

Vec3 origin_of(std::string_view scene, std::size_t player) {
    if (scene == "crawl") {
        return {k_between_m * static_cast<double>(player), 0.0, 0.0};
    }
    const double side = player % 2 == 0 ? 1.0 : -1.0;
    const std::size_t pair = player / 2;
    return {k_between_m * static_cast<double>(pair), 0.0, side * k_away_from_bar_m};
}

// Tremor of hands: about 9 Hz, another one for each axis of each device.
Vec3 hand_tremor(std::size_t player, std::size_t side, double t_s) {
    constexpr double k_size_m = 0.0003;
    Vec3 out;
    for (int axis = 0; axis < 3; ++axis) {
        const double number = 7.0 * static_cast<double>(player) + 3.0 * static_cast<double>(side) +
                              static_cast<double>(axis);
        out[axis] = k_size_m * std::sin((50.0 + 3.7 * std::fmod(1.7 * number, 4.0)) * t_s + number);
    }
    return out;
}

Vec3 palm_of(std::size_t side) {
    const Vec3 right = Tuning{}.hand.palm_center_m;
    return {side == 0 ? -right.x() : right.x(), right.y(), right.z()};
}

void crawl(std::size_t player, double t, TrackingSample& sample) {
    const auto number = static_cast<double>(player);
    sample.head_ps = {Vec3(0.02 * std::sin(t + number), 0.7, 0.0), Quat::Identity()};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double out = side == 0 ? -1.0 : 1.0;
        const Vec3 rest = Vec3(0.25 * out, 0.055, -0.3) - palm_of(side);
        const Vec3 wave(std::sin(2.0 * t + number), 0.0, out * std::sin(3.0 * t));
        const double phase = t + 0.35 * static_cast<double>(side) + 0.1 * number;
        sample.controllers[side].controller_ps = {rest + 0.1 * wave, Quat::Identity()};
        sample.controllers[side].grab = std::fmod(phase, 0.9) > 0.3;
    }
}

void pull_bar(std::size_t player, double t, TrackingSample& sample) {
    const double end = player % 2 == 0 ? -0.6 : 0.6;  // the bar's end, from the player
    const auto number = static_cast<double>(player);
    sample.head_ps = {Vec3(0.03 * std::sin(1.3 * t + number), 1.6, -0.1 * end),
                      rotation_about(Vec3::UnitY(), 0.2 * std::sin(0.9 * t))};
    const double on = std::clamp((t - 0.8) / 0.4, 0.0, 1.0);
    const Vec3 pull =
        0.12 * on *
        Vec3(std::sin(3.0 * t + number), 0.4 * std::sin(2.0 * t), std::sin(4.0 * t + number));
    const Vec3 rest = Vec3(0.0, k_bar_height_m + 0.035, end) - palm_of(1);
    sample.controllers[1].controller_ps = {rest + pull, Quat::Identity()};
    sample.controllers[1].grab = t > 0.3;
    sample.controllers[0].controller_ps = {
        Vec3(-0.45, 1.25 + 0.04 * std::sin(2.2 * t), -0.25 * end), Quat::Identity()};
}

}  // namespace

std::vector<std::string_view> match_scene_names() { return {"crawl", "bars"}; }

MatchScene::MatchScene(std::string_view name, std::size_t players) : players_(players) {
    add_body(world_, {"floor",
                      {},
                      {Vec3::Zero(), Quat::Identity()},
                      {},
                      shapes_.add_box(Vec3(40.0, 0.05, 40.0))});
    const ShapeId rock = shapes_.add_sphere(0.08);
    constexpr int k_rocks = 60;
    for (int i = 0; i < k_rocks; ++i) {
        add_body(world_, {"rock" + std::to_string(i),
                          {BodyKind::free, 1.0, Vec3::Constant(0.01), 0.2},
                          {Vec3(-2.0 + 0.3 * i, 0.3, 2.0), Quat::Identity()},
                          {},
                          rock});
    }
    if (name == "bars") {
        const ShapeId bar = shapes_.add_box(Vec3(0.03, 0.03, 0.4));
        for (std::size_t pair = 0; pair < (players + 1) / 2; ++pair) {
            add_body(world_, {"bar" + std::to_string(pair),
                              {BodyKind::free, 4.0, solid_inertia(shapes_.at(bar), 4.0), 0.2},
                              {Vec3(k_between_m * static_cast<double>(pair), k_bar_height_m, 0.0),
                               Quat::Identity()},
                              {},
                              bar});
        }
    }
    const ShapeId head = shapes_.add_sphere(tuning_.head.radius_m);
    for (std::size_t i = 0; i < players; ++i) {
        PlayerDescription description;
        const std::string player_name = name_of_player(i);
        description.name = player_name;
        description.origin_ws.position = origin_of(name, i);
        description.head_shape = head;
        for (const Entity hand : add_player(world_, description).hands) {
            world_.controller_to_hand.add(hand, {});
        }
    }
    grip_meshes_ = GripMeshLibrary(shapes_);
    caches_ = std::make_unique<FrameCaches>(shapes_, &grip_meshes_);
}

MatchWorld MatchScene::match(double tick_s) {
    MatchWorld out{.world = world_, .caches = *caches_, .tuning = tuning_, .dt_s = tick_s};
    out.player_count = players_;
    for (std::size_t i = 0; i < players_; ++i) {
        out.players[i] = persistent_id_from_name(name_of_player(i));
    }
    return out;
}

TrackingSample devices_at(std::string_view scene, std::size_t player, double t_s) {
    TrackingSample sample;
    sample.t_s = t_s;
    if (scene == "crawl") {
        crawl(player, t_s, sample);
    } else {
        pull_bar(player, t_s, sample);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        sample.controllers[side].controller_ps.position += hand_tremor(player, side, t_s);
    }
    return sample;
}

}  // namespace handhold::lab
