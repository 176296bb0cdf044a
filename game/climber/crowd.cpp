#include "game/climber/crowd.hpp"

#include <algorithm>
#include <stdexcept>

#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

constexpr double k_apart_m = 0.8;    // preferred distance between two heads
constexpr double k_closest_m = 0.3;  // minimum distance between two heads
// Length of the rays along which free places are searched. A ray that hits nothing is discarded,
// because it may lead out of the level.
constexpr double k_view_m = 8.0;
constexpr std::size_t k_max_attempts = 60;  // attempts per player until the distance is reduced

class Spreader {
  public:
    Spreader(hh::World& world, std::uint64_t seed) : world_(world), random_(Random::of(seed)) {}

    std::vector<hh::Vec3> heads;  // heads placed so far
    std::vector<hh::Vec3> seeds;  // heads at the scene's spawns: more start points for the search

    // Makes one attempt to add a head at a random free point: visible from a known head, and at
    // least `apart_m` from every placed head. False if the attempt failed.
    bool add(double apart_m) {
        const std::size_t known = heads.size() + seeds.size();
        const auto pick = static_cast<std::size_t>(random_.unit() * static_cast<double>(known));
        const hh::Vec3& from = pick < heads.size() ? heads[pick] : seeds[pick - heads.size()];
        const hh::Vec3 direction = random_.direction();
        const double share = random_.between(0.1, 0.9);
        const auto hit = world_.cast_ray(from, from + k_view_m * direction);
        if (!hit) {
            return false;
        }
        const hh::Vec3 place = from + share * hit->distance_m * direction;
        const bool too_near = std::ranges::any_of(
            heads, [&](const hh::Vec3& head) { return hh::length(head - place) < apart_m; });
        if (too_near || world_.closest_point(place, k_head_clear_m)) {
            return false;
        }
        heads.push_back(place);
        return true;
    }
    double turn_rad() { return random_.between(-3.14, 3.14); }

  private:
    hh::World& world_;
    Random random_;
};

}  // namespace

hh::Vec3 head_over(const hh::Pose& origin_ws) {
    return hh::transform_point(origin_ws, hh::Vec3{0.0, k_eye_height_m, 0.0});
}

std::vector<hh::Pose> spread_players(Scene& scene, const hh::Pose& first_ws, std::size_t count,
                                     std::uint64_t seed) {
    Spreader spreader(scene.host, seed);
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
    std::vector<hh::Pose> places = {first_ws};
    const hh::Quat upright = hh::rotation_between(hh::k_y, to_host(scene.up_ws));
    for (std::size_t i = 1; i < spreader.heads.size(); ++i) {
        const hh::Quat rotation =
            hh::normalized(upright * hh::rotation_about(hh::k_y, spreader.turn_rad()));
        places.push_back(
            {spreader.heads[i] - rotation * hh::Vec3{0.0, k_eye_height_m, 0.0}, rotation});
    }
    return places;
}

Crowd::Crowd(const hh::World& world, std::span<const hh::Player> players, std::uint64_t seed)
    : samples_(players.size()) {
    Random random = Random::of(seed);
    for (const hh::Player player : players) {
        ClimberTask task;
        task.player = player;
        task.cruise_mps = random.between(0.4, 0.8);
        task.team = team_of(world, player);
        tasks_.push_back(task);
        states_.push_back(begin_climber(world, task, random.bits()));
    }
}

void Crowd::drive(const ClimberSight& sight, double frame_end_s,
                  std::span<hh_player_input> inputs) {
    if (inputs.size() != tasks_.size()) {
        throw std::invalid_argument("a crowd needs one input a climber");
    }
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        const hh_commands commands = climb(sight, tasks_[i], frame_end_s, states_[i], samples_[i]);
        inputs[i] = hh::input(tasks_[i].player, samples_[i], commands);
        inputs[i].repeats_samples = true;
    }
}

}  // namespace handhold
