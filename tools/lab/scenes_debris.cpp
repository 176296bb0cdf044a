// Scenes of loose bodies without hands: impacts of balls, drifting boxes, and boxes that overlap at
// the start.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/core/hash.hpp"
#include "tools/lab/box_overlap.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

// --- Impact --------------------------------------------------------------------------------------

constexpr double k_ball_m = 0.05;     // radius of the balls at rest
constexpr double k_striker_m = 0.03;  // radius of the striking balls
constexpr double k_lane_m = 20.0;     // distance of the pairs
constexpr double k_apart_s = 0.3;     // time in which every pair has met and parted

struct Impact {
    double speed_mps;
    double
        offset;  // distance of the striker's path from the ball's centre, as a share of both radii
    double striker_kg;
    double restitution;
};
constexpr std::array k_impacts = {
    Impact{0.5, 0.0, 1.0, 1.0},  Impact{1.0, 0.3, 1.0, 0.0},  Impact{2.0, 0.6, 0.1, 1.0},
    Impact{3.0, 0.9, 1.0, 0.5},  Impact{5.0, 0.0, 10.0, 0.8}, Impact{5.0, 0.5, 1.0, 1.0},
    Impact{10.0, 0.7, 1.0, 0.0}, Impact{20.0, 0.2, 0.1, 0.5}, Impact{50.0, 0.8, 1.0, 1.0},
};

int add_ball(LabScene& scene, double radius_m, double mass_kg, double restitution,
             const Vec3& center) {
    LabBody ball;
    ball.name = "ball" + std::to_string(scene.bodies.size());
    ball.mass_kg = mass_kg;
    ball.half_m = Vec3::Constant(radius_m);
    ball.is_ball = true;
    ball.pose_ws.position = center;
    ball.restitution = restitution;
    ball.collides = true;
    return scene.add_body(ball);
}

// Velocities of striker and ball after the impact. Along the line of centres they follow Newton's
// law of restitution. Across it they do not change, because the balls have no friction.
std::array<Vec3, 2> velocities_after(const Impact& impact) {
    const Vec3 normal(-std::sqrt(1.0 - impact.offset * impact.offset), impact.offset, 0.0);
    const Vec3 before = impact.speed_mps * Vec3::UnitX();
    constexpr double k_ball_kg = 1.0;
    const double reduced_kg = impact.striker_kg * k_ball_kg / (impact.striker_kg + k_ball_kg);
    const Vec3 impulse = -(1.0 + impact.restitution) * reduced_kg * before.dot(normal) * normal;
    return {before + impulse / impact.striker_kg, -impulse / k_ball_kg};
}

// --- Boxes ---------------------------------------------------------------------------------------

// Numbers in [-1, 1), the same on every machine.
class Numbers {
  public:
    double next() {
        state_ = mix64(state_ + 0x9e3779b97f4a7c15ULL);
        return 2.0 * std::ldexp(static_cast<double>(state_ >> 11U), -53) - 1.0;
    }
    Vec3 next_vector() {
        const double x = next();
        const double y = next();
        return {x, y, next()};
    }

  private:
    std::uint64_t state_ = 1;
};

int add_debris(LabScene& scene, const Vec3& half_m, const Vec3& center, Numbers& numbers) {
    LabBody box;
    box.name = "debris" + std::to_string(scene.bodies.size());
    box.mass_kg = 1.0 + 0.9 * numbers.next();
    box.half_m = half_m;
    box.pose_ws = {center, rotation_from_vector(k_pi * numbers.next_vector())};
    box.friction = 0.4;
    box.collides = true;
    return scene.add_body(box);
}

double deepest_overlap_m(const LabScene& scene, const FrameRecord& frame) {
    std::vector<std::size_t> order(scene.bodies.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto low_x = [&](std::size_t i) {
        return frame.poses[i].position.x() - scene.bodies[i].half_m.norm();
    };
    std::ranges::sort(order, {}, low_x);
    double deepest_m = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t a = order[i];
        const double high_x = frame.poses[a].position.x() + scene.bodies[a].half_m.norm();
        for (std::size_t j = i + 1; j < order.size() && low_x(order[j]) < high_x; ++j) {
            const std::size_t b = order[j];
            deepest_m = std::max(deepest_m, box_overlap_m(frame.poses[a], scene.bodies[a].half_m,
                                                          frame.poses[b], scene.bodies[b].half_m));
        }
    }
    return deepest_m;
}

double kinetic_energy_j(const LabScene& scene, const FrameRecord& frame) {
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Vec3 spin_bs =
            frame.poses[i].rotation.conjugate() * frame.velocities[i].angular_radps;
        sum += 0.5 * scene.bodies[i].mass_kg * frame.velocities[i].linear_mps.squaredNorm() +
               0.5 * spin_bs.cwiseProduct(scene.bodies[i].inertia_kgm2()).dot(spin_bs);
    }
    return sum;
}

}  // namespace

LabScene make_impact(const SceneOptions& /*options*/) {
    LabScene scene;
    std::vector<Vec3> expected;
    for (const Impact& impact : k_impacts) {
        const Vec3 lane = k_lane_m * static_cast<double>(expected.size()) * Vec3::UnitZ();
        const double aside_m = impact.offset * (k_ball_m + k_striker_m);
        // The striker reaches the ball after about a third of k_apart_s.
        const double ahead_m = k_ball_m + k_striker_m + 0.3 * k_apart_s * impact.speed_mps;
        add_ball(scene, k_striker_m, impact.striker_kg, impact.restitution,
                 lane + Vec3(-ahead_m, aside_m, 0.0));
        scene.bodies.back().velocity.linear_mps = impact.speed_mps * Vec3::UnitX();
        add_ball(scene, k_ball_m, 1.0, impact.restitution, lane);
        for (const Vec3& velocity : velocities_after(impact)) {
            expected.push_back(velocity);
        }
    }
    // closed_in_spin stays false: the solver moves overlapping bodies apart without giving them a
    // velocity, which changes the angular momentum.
    scene.closed_from_s = 0.0;
    scene.watch = [expected](const FrameRecord& frame, Figures& figures) {
        if (frame.t_s < k_apart_s) {
            return;
        }
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const double speed_mps = k_impacts[i / 2].speed_mps;
            const double error = (frame.velocities[i].linear_mps - expected[i]).norm() / speed_mps;
            figures.take_worst("impact_velocity_error", error);
        }
    };
    return scene;
}

LabScene make_debris(const SceneOptions& options) {
    LabScene scene;
    Numbers numbers;
    constexpr double k_pitch_m = 0.5;
    constexpr double k_half_m = 0.1;
    constexpr double k_speed_mps = 0.5;
    const int count = options.links_or(32);
    const int side = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count))));
    for (int i = 0; i < count; ++i) {
        const int layer = i / (side * side);
        const int row = i / side % side;
        const Vec3 cell(layer, row, i % side);
        add_debris(scene, Vec3::Constant(k_half_m), k_pitch_m * cell, numbers);
        scene.bodies.back().restitution = 0.5 + 0.5 * numbers.next();
        scene.bodies.back().velocity = {k_speed_mps * numbers.next_vector(),
                                        k_speed_mps * numbers.next_vector()};
    }
    // closed_in_spin stays false: the solver moves overlapping bodies apart without giving them a
    // velocity, which changes the angular momentum.
    scene.closed_from_s = 0.0;
    // Copied before `watch` is set. Otherwise the lambda would contain a copy of itself.
    const LabScene bodies = scene;
    scene.watch = [bodies, first_j = -1.0](const FrameRecord& frame, Figures& figures) mutable {
        const double energy_j = kinetic_energy_j(bodies, frame);
        first_j = first_j < 0.0 ? energy_j : first_j;
        figures.take_worst("energy_gain", energy_j / first_j - 1.0);
        figures.take_worst("overlap_mm", 1e3 * deepest_overlap_m(bodies, frame));
    };
    return scene;
}

LabScene make_overlap(const SceneOptions& options) {
    LabScene scene;
    Numbers numbers;
    constexpr double k_place_m = 0.1;  // half edge of the cube that holds all centres
    constexpr double k_half_m = 0.1;
    for (int i = 0; i < options.links_or(32); ++i) {
        add_debris(scene, Vec3::Constant(k_half_m), k_place_m * numbers.next_vector(), numbers);
    }
    const LabScene bodies = scene;
    // Depenetration moves the bodies, but must not give them speed.
    scene.watch = [bodies](const FrameRecord& frame, Figures& figures) {
        double speed_mps = 0.0;
        for (const BodyVelocity& velocity : frame.velocities) {
            speed_mps = std::max(speed_mps, velocity.linear_mps.norm());
        }
        figures.take_worst("speed_mps", speed_mps);
        figures.set("overlap_left_mm", 1e3 * deepest_overlap_m(bodies, frame));
    };
    return scene;
}

}  // namespace handhold::lab
