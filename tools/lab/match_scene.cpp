#include "tools/lab/match_scene.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "components/player.hpp"

namespace handhold::lab {
namespace {

std::string name_of_player(std::size_t player) { return "player" + std::to_string(player); }

// Distance of neighbours, or of pairs.
double between_m(const MatchSetting& setting) {
    return setting.scene == "together" || setting.scene == "recorded" ? 4.0 : 2.0;
}

Vec3 place_of_pair(const MatchSetting& setting, std::size_t pair) {
    return {between_m(setting) * static_cast<double>(pair), 0.0, 0.0};
}

Pose origin_of(const MatchSetting& setting, std::size_t player) {
    const Vec3 alone(between_m(setting) * static_cast<double>(player), 0.0, 0.0);
    if (setting.scene == "crawl") {
        return {alone, Quat::Identity()};
    }
    if (setting.scene == "recorded") {  // the head begins above its place
        const Recording& recording = setting.recordings[player % setting.recordings.size()];
        const hh_vec3& head = recording.samples.front().head.position;
        return {std::isfinite(head.x) ? Vec3(alone - Vec3(head.x, 0.0, head.z)) : alone,
                Quat::Identity()};
    }
    const bool is_first = player % 2 == 0;
    const Vec3 pair = place_of_pair(setting, player / 2);
    if (task_of_pair(setting, player / 2) == PairTask::hold_each_other) {  // face to face
        return {pair + Vec3(0.0, 0.0, is_first ? k_face_to_face_m : -k_face_to_face_m),
                rotation_about(Vec3::UnitY(), is_first ? 0.0 : std::numbers::pi)};
    }
    return {pair + Vec3(0.0, 0.0, is_first ? k_from_pair_m : -k_from_pair_m), Quat::Identity()};
}

}  // namespace

void MatchScene::add_free(const std::string& name, ShapeId shape, double mass_kg,
                          const Vec3& at_ws) {
    add_body(world_, {name,
                      {BodyKind::free, mass_kg, solid_inertia(shapes_.at(shape), mass_kg), 0.2},
                      {at_ws, Quat::Identity()},
                      {},
                      shape});
}

void MatchScene::add_floor() {
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
}

void MatchScene::add_pair(PairTask task, std::size_t pair, const Vec3& at_ws) {
    const Vec3 middle_ws = at_ws + Vec3(0.0, k_pair_height_m, 0.0);
    const std::string number = std::to_string(pair);
    if (task == PairTask::pull_bar) {
        add_free("bar" + number, shapes_.add_box(Vec3(k_pair_half_m, k_pair_half_m, 0.4)), 4.0,
                 middle_ws);
    } else if (task == PairTask::hand_over) {
        add_free("tool" + number, shapes_.add_box(Vec3(k_pair_half_m, k_pair_half_m, 0.4)), 1.5,
                 middle_ws);
    } else if (task == PairTask::swing_door) {
        const std::string name = "door" + number;
        add_free(name, shapes_.add_box(Vec3(k_board_half_m, k_pair_half_m, k_board_half_m)), 20.0,
                 middle_ws);
        Joint hinge;
        hinge.kind = JointKind::hinge;
        hinge.b = find_by_name(world_, name);
        hinge.limited = true;
        hinge.lower = -0.8;
        hinge.upper = 0.8;
        const Pose frame_ws = {middle_ws - Vec3(k_board_half_m, 0.0, 0.0),
                               rotation_between(Vec3::UnitX(), Vec3::UnitZ())};
        add_joint(world_, {"hinge" + number, joint_at(world_, hinge, frame_ws)});
    }
}

MatchScene::MatchScene(const MatchSetting& setting) : players_(setting.players) {
    add_floor();
    const bool has_pairs = setting.scene == "bars" || setting.scene == "together";
    for (std::size_t pair = 0; has_pairs && pair < (players_ + 1) / 2; ++pair) {
        add_pair(task_of_pair(setting, pair), pair, place_of_pair(setting, pair));
    }
    const ShapeId head = shapes_.add_sphere(tuning_.head.radius_m);
    const ShapeId ball = shapes_.add_sphere(k_ball_radius_m);
    const ShapeId grip_rock = shapes_.add_sphere(k_grip_rock_m);
    for (std::size_t i = 0; i < players_; ++i) {
        PlayerDescription description;
        const std::string player_name = name_of_player(i);
        description.name = player_name;
        description.origin_ws = origin_of(setting, i);
        description.head_shape = head;
        for (const Entity hand : add_player(world_, description).hands) {
            world_.controller_to_hand.add(hand, {});
        }
        if (setting.scene == "together") {
            add_free("ball" + std::to_string(i), ball, 0.2,
                     transform_point(description.origin_ws, ball_ps(i)));
        }
        if (setting.scene == "recorded") {
            int number = 0;
            for (const Vec3& place_ps :
                 grip_rocks_ps(setting.recordings[i % setting.recordings.size()])) {
                add_free("grip" + std::to_string(i) + "_" + std::to_string(number++), grip_rock,
                         1.0, transform_point(description.origin_ws, place_ps));
            }
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

}  // namespace handhold::lab
