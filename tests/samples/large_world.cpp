// The guide's large world: the same play near the origin, far away and at speed, and a level whose
// pieces come and go around the player.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <thread>
#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr int k_frames = 180;

double ramp(double t_s, double from_s, double to_s) {
    return std::clamp((t_s - from_s) / (to_s - from_s), 0.0, 1.0);
}

// The right hand grips the wall and pulls, then lets go. The left hand takes a crate and shoves it
// 20 cm farther than the wall allows, which pushes the player back.
hh::Sample devices_at(double t_s) {
    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head.position = {0.0, 1.6, 0.1};
    const hh::Quat palm_to_wall{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    const hh::Vec3 right{0.2, 1.4, -0.43 + 0.1 * ramp(t_s, 0.3, 0.8)};
    const hh::Vec3 left{-0.2, 1.4, -0.2 - 0.25 * ramp(t_s, 1.1, 1.7)};
    sample.hands[HH_RIGHT] = hh::pose_at(right, palm_to_wall);
    sample.hands[HH_LEFT] = hh::pose_at(left, palm_to_wall);
    sample.grab[HH_RIGHT] = t_s > 0.2 && t_s < 0.9;
    sample.grab[HH_LEFT] = t_s > 0.1;
    return sample;
}

// A path relative to where the play began, which moves at `speed_mps` along x.
struct Path {
    std::vector<hh::Vec3> points;  // player and crate, by frame
    double hand_error_m = 0.0;
    double step_us = 0.0;  // mean
    bool was_pushed_back = false;
    bool is_valid = false;
};

Path play(hh::Vec3 offset, double speed_mps) {
    Path path;
    hh::World world;
    const hh::Vec3 velocity{speed_mps, 0.0, 0.0};
    hh_body_def wall = hh::body_def();
    wall.kind = HH_KINEMATIC;
    wall.shape = *world.add_box({2.0, 2.0, 0.1});
    wall.pose.position = offset + hh::Vec3{0.0, 1.5, -0.6};
    wall.velocity_mps = velocity;
    hh_body_def crate = hh::body_def();
    crate.kind = HH_DYNAMIC;
    crate.mass_kg = 5.0;
    crate.shape = *world.add_box({0.05, 0.05, 0.05});
    crate.pose.position = offset + hh::Vec3{-0.2, 1.48, -0.3};
    crate.velocity_mps = velocity;
    hh_player_def you = hh::player_def();
    you.origin.position = offset;
    you.velocity_mps = velocity;
    const hh::Body wall_id = *world.add(wall);
    const hh::Body crate_id = *world.add(crate);
    const hh::Player player = *world.add(you);
    if (hh_world_set_reference_velocity(world.get(), velocity) != HH_OK ||
        !world.use_wrists(player)) {
        return path;
    }
    double pulled_m = 0.0;
    for (int frame = 1; frame <= k_frames; ++frame) {
        const hh::Vec3 moved = offset + frame * k_dt_s * velocity;
        const hh::Sample sample = devices_at(frame * k_dt_s);
        if (!world.move_kinematic(wall_id, hh::pose_at(moved + hh::Vec3{0.0, 1.5, -0.6})) ||
            !world.step(k_dt_s, hh::input(player, {&sample, 1}))) {
            std::printf("%s\n", hh_last_error());
            return path;
        }
        const hh_world_stats stats = *world.stats();
        path.hand_error_m = std::fmax(path.hand_error_m, stats.hand_error_m);
        path.step_us += stats.step_us / k_frames;
        path.points.push_back(world.pose(player)->origin.position - moved);
        path.points.push_back(world.pose(crate_id)->position - moved);
        if (frame == 99) {  // before the shove
            pulled_m = path.points[path.points.size() - 2].z;
        }
    }
    path.was_pushed_back = path.points[path.points.size() - 2].z > pulled_m + 0.09;
    path.is_valid = true;
    return path;
}

// Largest difference of two paths.
double difference_m(const Path& a, const Path& b) {
    double worst_m = 0.0;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        worst_m = std::fmax(worst_m, hh::length(a.points[i] - b.points[i]));
    }
    return worst_m;
}

hh::Mesh floor_piece(int column);

// [stream]
// A corridor of pieces, 10 m each, in a world of any length. A loading thread prepares a piece, and
// its body lies where the piece lies: vertices stay small, so that floats suffice for them.
struct Corridor {
    hh::World& world;
    std::map<int, hh_body_def> here;  // by column
    std::map<int, hh::Body> bodies;

    bool enter(int column, const hh::Mesh& prepared) {
        hh_body_def piece = hh::body_def();
        piece.shape = world.add_mesh(prepared).value_or({});
        piece.pose.position = {10.0 * column, 0.0, 0.0};
        const auto body = world.add(piece);
        here[column] = piece;
        bodies[column] = body.value_or({});
        return static_cast<bool>(body);
    }
    bool leave(int column) {  // bodies first, then their shape
        const bool is_gone = world.remove(bodies.at(column)) && world.remove(here.at(column).shape);
        here.erase(column);
        bodies.erase(column);
        return is_gone;
    }
};
// [stream]

// A floor of 10 m and 50 triangles, 0.2 m of bumps.
hh::Mesh floor_piece(int column) {
    std::vector<float> xyz;
    std::vector<std::uint32_t> indices;
    for (int x = 0; x <= 5; ++x) {
        for (int z = 0; z <= 5; ++z) {
            xyz.insert(xyz.end(), {2.0F * static_cast<float>(x),
                                   0.1F * std::sin(static_cast<float>(x + z + column)),
                                   2.0F * static_cast<float>(z) - 5.0F});
        }
    }
    for (std::uint32_t x = 0; x < 5; ++x) {
        for (std::uint32_t z = 0; z < 5; ++z) {
            const std::uint32_t corner = 6 * x + z;
            indices.insert(indices.end(),
                           {corner, corner + 1, corner + 7, corner, corner + 7, corner + 6});
        }
    }
    return {xyz, indices};
}

}  // namespace

int main() {
    bool is_right = true;
    const Path here = play({}, 0.0);
    is_right = here.is_valid && here.was_pushed_back;
    struct Place {
        const char* name;
        hh::Vec3 offset;
        double speed_mps;
        double limit_m;  // promised; 0: printed only
    };
    const Place places[] = {{"10 km away", {1e4, -3e3, 7e3}, 0.0, 1e-6},
                            {"1,000 km away", {1e6, -3e5, 7e5}, 0.0, 1e-6},
                            {"10,000 km away", {1e7, -3e6, 7e6}, 0.0, 0.0},
                            {"1,000,000 km away", {9e8, -3e8, 7e8}, 0.0, 0.0},
                            {"at 1,000 m/s", {}, 1e3, 1e-6},
                            {"at 10,000 m/s", {}, 1e4, 0.0}};
    std::printf("near the origin: hand error %.1e m, %.1f us a step\n", here.hand_error_m,
                here.step_us);
    for (const Place& place : places) {
        const Path there = play(place.offset, place.speed_mps);
        const double worst_m = there.is_valid ? difference_m(here, there) : HUGE_VAL;
        std::printf("%s: differs by %.1e m, hand error %.1e m, %.1f us a step\n", place.name,
                    worst_m, there.hand_error_m, there.step_us);
        is_right = is_right && (place.limit_m == 0.0 || worst_m <= place.limit_m);
    }

    hh::World world;
    Corridor corridor{world, {}, {}};
    for (int column = 0; column < 100; ++column) {
        hh::Mesh piece;
        std::thread loading([&] { piece = floor_piece(column); });
        loading.join();
        is_right = is_right && corridor.enter(column, piece) &&
                   (column < 3 || corridor.leave(column - 3)) && world.step(k_dt_s);
    }
    const hh_world_stats left = *world.stats();
    std::printf("a kilometre of corridor: %d bodies and %d shapes at its end\n",
                static_cast<int>(left.bodies), static_cast<int>(left.shapes));
    return is_right && left.bodies == 3 && left.shapes == 3 ? 0 : 1;
}
