#include "game/climber/crowd.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "game/scene/place_scene.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

constexpr double k_apart_m = 0.8;    // preferred distance between two heads
constexpr double k_closest_m = 0.3;  // minimum distance between two heads
// Length of a ray; a ray that hits nothing leads outside.
constexpr double k_view_m = 8.0;
constexpr std::size_t k_max_attempts = 60;  // attempts per player until the distance is reduced

class Spreader {
  public:
    Spreader(const CollisionWorld& collision, std::uint64_t seed)
        : collision_(collision), random_(mix64(seed)) {}

    std::vector<Vec3> heads;  // heads placed so far
    std::vector<Vec3> seeds;  // heads at the scene's spawns: more start points for the search

    // Makes one attempt to add a head at a random free point: visible from a known head, and at
    // least `apart_m` from every placed head. False if the attempt failed.
    bool add(double apart_m) {
        const std::size_t known = heads.size() + seeds.size();
        const auto pick = static_cast<std::size_t>(random_.unit() * static_cast<double>(known));
        const Vec3& from = pick < heads.size() ? heads[pick] : seeds[pick - heads.size()];
        const Vec3 direction = random_.direction();
        const double share = random_.between(0.1, 0.9);
        const auto hit = collision_.cast_ray(from, from + k_view_m * direction);
        if (!hit) {
            return false;
        }
        const Vec3 place = from + share * hit->distance_m * direction;
        const bool too_near = std::ranges::any_of(
            heads, [&](const Vec3& head) { return (head - place).norm() < apart_m; });
        if (too_near || collision_.closest_point(place, k_head_clear_m)) {
            return false;
        }
        heads.push_back(place);
        return true;
    }
    double turn_rad() { return random_.between(-3.14, 3.14); }

  private:
    const CollisionWorld& collision_;
    Random random_;
};

}  // namespace

Vec3 head_over(const Pose& origin_ws) {
    return transform_point(origin_ws, Vec3(0.0, k_eye_height_m, 0.0));
}

std::vector<Pose> spread_players(const Scene& scene, FrameCaches& caches, const Pose& first_ws,
                                 std::size_t count, std::uint64_t seed) {
    place_scene(scene, caches);
    Spreader spreader(caches.collision, seed);
    spreader.heads.push_back(head_over(first_ws));
    for (const SceneSpawnPoint& spawn : scene.spawns) {
        spreader.seeds.push_back(head_over(spawn.pose_ws));
    }
    for (double apart_m = k_apart_m; apart_m >= k_closest_m; apart_m -= 0.1) {
        for (std::size_t tries = 0; tries < k_max_attempts * count && spreader.heads.size() < count;
             ++tries) {
            spreader.add(apart_m);
        }
    }
    std::vector<Pose> places = {first_ws};
    const Quat upright = rotation_between(Vec3::UnitY(), scene.up_ws);
    for (std::size_t i = 1; i < spreader.heads.size(); ++i) {
        const Quat rotation =
            (upright * rotation_about(Vec3::UnitY(), spreader.turn_rad())).normalized();
        places.push_back({spreader.heads[i] - rotation * Vec3(0.0, k_eye_height_m, 0.0), rotation});
    }
    return places;
}

Crowd::Crowd(const Scene& scene, std::span<const PlayerEntities> players, std::uint64_t seed)
    : samples_(players.size()) {
    Random random(mix64(seed));
    for (const PlayerEntities& player : players) {
        ClimberTask task;
        task.player = player;
        task.cruise_mps = random.between(0.4, 0.8);
        tasks_.push_back(task);
        states_.push_back(begin_climber(scene, task, random.bits()));
    }
}

void Crowd::drive(const Scene& scene, FrameCaches& caches, double frame_end_s,
                  std::span<PlayerInput> inputs) {
    HH_CHECK(inputs.size() == tasks_.size(), "one input a climber", inputs.size());
    if (tasks_.empty()) {
        return;
    }
    place_scene(scene, caches);
    const ClimberSight sight{scene, caches.collision};
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        const PlayerCommands commands =
            climb(sight, tasks_[i], frame_end_s, states_[i], samples_[i]);
        inputs[i] = {tasks_[i].player.player, samples_[i], commands};
    }
}

}  // namespace handhold
