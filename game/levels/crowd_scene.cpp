#include "game/levels/crowd_scene.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "game/climber/crowd.hpp"
#include "game/mesh/primitives.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/scene/random.hpp"

namespace handhold {
namespace {

constexpr int k_climbers = 12;
constexpr std::size_t k_body_count = 24;
constexpr std::uint64_t k_seed = 7;
// No bodies are added within this distance of the first spawn, where the session begins.
constexpr double k_session_clearance_m = 3.0;

struct CrowdBodyKind {
    const char* name;
    double mass_kg;
    Vec3 half_m;  // half extents of a box; a ball of radius x() if y() is zero
    Color color;
};
constexpr std::size_t k_body_kinds = 4;

std::array<CrowdBodyKind, k_body_kinds> kinds() {
    return {{{"crate", 8.0, Vec3(0.12, 0.09, 0.10), {0.55F, 0.40F, 0.16F}},
             {"ball", 1.5, Vec3(0.09, 0.0, 0.0), {0.70F, 0.12F, 0.08F}},
             {"bag", 20.0, Vec3(0.20, 0.13, 0.13), {0.62F, 0.60F, 0.55F}},
             {"can", 0.6, Vec3(0.05, 0.08, 0.05), {0.10F, 0.32F, 0.55F}}}};
}

void add_free_body(Scene& scene, const CrowdBodyKind& kind, const std::string& name,
                   const Pose& pose_ws, const BodyVelocity& velocity) {
    const bool ball = kind.half_m.y() == 0.0;
    BodyDescription body;
    body.name = name;
    body.shape =
        ball ? scene.shapes().add_sphere(kind.half_m.x()) : scene.shapes().add_box(kind.half_m);
    body.body = {BodyKind::free, kind.mass_kg,
                 solid_inertia(scene.shapes().at(body.shape), kind.mass_kg), 0.3};
    body.pose_ws = pose_ws;
    body.velocity = velocity;
    const Entity entity = add_body(scene.world(), body, scene.shapes());
    scene.body_names.push_back(name);
    Mesh mesh = ball ? make_sphere(kind.half_m.x()) : make_box(kind.half_m);
    scene.visuals.push_back(
        {entity, std::make_shared<const Mesh>(std::move(mesh)), kind.color, {}});
}

}  // namespace

void fill_with_crowd(Scene& scene) {
    scene.climbers = k_climbers;
    scene.tuning().locomotion.thruster_mps2 =
        std::max(scene.tuning().locomotion.thruster_mps2, k_jets_mps2);
    const hh::Pose first_ws = scene.spawns.front().pose_ws;
    const std::vector<hh::Pose> places = spread_players(scene, first_ws, 4 * k_body_count, k_seed);
    Random random(k_seed);
    std::size_t made = 0;
    for (const hh::Pose& place : places) {
        const hh::Vec3 center_ws = head_over(place);
        const hh::Vec3 drift = 0.05 * random.direction();
        const hh::Vec3 spin = 0.3 * random.direction();
        if (made == k_body_count ||
            hh::length(center_ws - head_over(first_ws)) < k_session_clearance_m) {
            continue;
        }
        const CrowdBodyKind kind = kinds()[made % k_body_kinds];
        add_free_body(scene, kind, std::string(kind.name) + std::to_string(made),
                      from_host({center_ws, place.rotation}), {from_host(drift), from_host(spin)});
        ++made;
    }
}

}  // namespace handhold
