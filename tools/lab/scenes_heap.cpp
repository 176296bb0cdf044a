// Scene in which a hand pushes a crate into a heap of crates in front of a wall.
#include <algorithm>
#include <cmath>

#include "tools/lab/box_overlap.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

constexpr double k_crate_half_m = 0.1;
constexpr double k_pitch_m = 2.0 * k_crate_half_m + 0.005;
constexpr double k_shove_m = 0.6;

// Displacement of the hand, m. The hand is at rest at both ends of the movement.
double shoved_m(double t_s) {
    constexpr double k_begin_s = 0.2;
    constexpr double k_duration_s = 0.4;
    const double share = std::clamp((t_s - k_begin_s) / k_duration_s, 0.0, 1.0);
    return k_shove_m * share * share * (3.0 - 2.0 * share);
}

void add_crate(LabScene& scene, double mass_kg, const Vec3& center) {
    LabBody crate;
    crate.name = "crate" + std::to_string(scene.bodies.size());
    crate.mass_kg = mass_kg;
    crate.half_m = Vec3::Constant(k_crate_half_m);
    crate.pose_ws.position = center;
    crate.friction = 0.5;
    crate.collides = true;
    scene.add_body(crate);
}

}  // namespace

LabScene make_heap(const SceneOptions& options) {
    LabScene scene;
    LabBody wall;
    wall.name = "wall";
    wall.kind = BodyKind::fixed;
    wall.half_m = Vec3(0.1, 3.0, 3.0);
    wall.pose_ws.position.x() = -0.1;
    wall.friction = 0.5;
    wall.collides = true;
    scene.add_body(wall);
    scene.planes.push_back({Vec3::UnitX(), 0.0});

    // Edge length, in crates, of the largest cube with at most `links` crates.
    const int side = static_cast<int>(std::cbrt(static_cast<double>(options.links_or(32)) + 0.5));
    const double middle = 0.5 * (side - 1);
    const double front_m = side * k_pitch_m + 0.005;
    const Vec3 held(front_m + k_crate_half_m + 0.15, 0.0, 0.0);
    add_crate(scene, 2.0, held);
    for (int i = 0; i < side * side * side; ++i) {
        const int layer = i / (side * side);
        const int row = i / side % side;
        const Vec3 cell(layer, row - middle, i % side - middle);
        add_crate(scene, 5.0, k_pitch_m * cell + Vec3(k_crate_half_m + 0.005, 0.0, 0.0));
    }
    scene.players.emplace_back();
    scene.players.back().head_ps = held + Vec3(0.5, 0.5, 0.0);
    LabHold hold;
    hold.body = 1;
    hold.hand_ps = [held](double t_s) {
        return Pose{held - shoved_m(t_s) * Vec3::UnitX(), Quat::Identity()};
    };
    scene.add_hold(hold);
    scene.needs_player = true;
    const std::size_t end = scene.bodies.size();
    scene.watch = [end](const FrameRecord& frame, Figures& figures) {
        const Vec3 half_m = Vec3::Constant(k_crate_half_m);
        double worst_m = 0.0;
        for (std::size_t a = 1; a < end; ++a) {
            for (std::size_t b = a + 1; b < end; ++b) {
                worst_m = std::max(worst_m,
                                   box_overlap_m(frame.poses[a], half_m, frame.poses[b], half_m));
            }
        }
        figures.take_worst("overlap_mm", 1e3 * worst_m);
    };
    return scene;
}

}  // namespace handhold::lab
