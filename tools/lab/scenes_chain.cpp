// Scenes with many links of 0.1 m: a chain hanging from the world, a closed ring, a hub.
#include <algorithm>
#include <cmath>

#include "tools/lab/hand_paths.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

constexpr double k_link_m = 0.1;
constexpr double k_reach_used = 0.98;
const Vec3 k_link_half(0.05, 0.02, 0.02);

// Mass of link i of n. With alternating masses, the last link, which is held, is light.
double link_mass(const std::string& masses, int i, int n) {
    const bool is_last = i == n - 1;
    const bool alternates = (n - 1 - i) % 2 == 1;
    if (masses == "last_x100") {
        return is_last ? 100.0 : 1.0;
    }
    if (masses == "last_x0.01") {
        return is_last ? 0.01 : 1.0;
    }
    if (masses == "alternate_x100") {
        return alternates ? 100.0 : 1.0;
    }
    if (masses == "alternate_x1000") {
        return alternates ? 1000.0 : 1.0;
    }
    if (masses == "middle_x100") {
        return i == n / 2 ? 100.0 : 1.0;
    }
    return 1.0;
}

LabBody make_link(const std::string& name, double mass_kg, const Vec3& from, const Vec3& to) {
    LabBody link;
    link.name = name;
    link.mass_kg = mass_kg;
    link.half_m = k_link_half;
    link.pose_ws = {0.5 * (from + to), rotation_between(Vec3::UnitX(), (to - from).normalized())};
    return link;
}

// Links between consecutive points, joined by ball joints; the first is joined to the world.
void add_links(LabScene& scene, const std::vector<Vec3>& places, const std::string& masses) {
    const int count = static_cast<int>(places.size()) - 1;
    for (int i = 0; i < count; ++i) {
        const auto place = static_cast<std::size_t>(i);
        const int link =
            scene.add_body(make_link("link" + std::to_string(i), link_mass(masses, i, count),
                                     places[place], places[place + 1]));
        LabJoint joint;
        joint.a = link - 1;
        joint.b = link;
        scene.add_joint_at(joint, {places[place], Quat::Identity()});
    }
}

// Corners of a zigzag from the world's origin to `end`, in the plane of the direction to `end` and
// y. For an odd number of links, the last one lies along that direction.
std::vector<Vec3> zigzag(int links, const Vec3& end) {
    const int folded = links - links % 2;
    const double span_m = end.norm() - k_link_m * (links % 2);
    const Vec3 along = end.normalized();
    const Vec3 across = (Vec3::UnitY() - along.y() * along).normalized();
    const double step = span_m / folded;
    const double height = std::sqrt(std::max(0.0, k_link_m * k_link_m - step * step));
    std::vector<Vec3> places;
    for (int i = 0; i <= folded; ++i) {
        places.emplace_back(step * i * along + (i % 2 == 1 ? height : 0.0) * across);
    }
    if (links % 2 == 1) {
        places.push_back(end);
    }
    return places;
}

// Adds a player whose hand holds the last link, at the point where `path` starts.
void hold_end(LabScene& scene, const PathOfTime& path) {
    scene.players.emplace_back();
    LabHold hold;
    hold.body = static_cast<int>(scene.bodies.size()) - 1;
    hold.hand_ps = path;
    hold.point_only = true;
    scene.add_hold(hold);
}

}  // namespace

LabScene make_chain(const SceneOptions& options) {
    LabScene scene;
    const int links = options.links_or(32);
    const double farthest = k_reach_used * k_link_m * links;
    const double swing = std::min(0.3 * farthest, 1.0);
    const std::vector<Vec3> corners = {Vec3(farthest - swing, 0.0, 0.0), Vec3(farthest, 0.0, 0.0),
                                       Vec3(farthest - swing, 0.0, 0.0),
                                       Vec3(farthest - swing, 0.5 * swing, 0.25 * swing),
                                       Vec3(farthest - 0.5 * swing, -0.3 * swing, 0.0)};
    add_links(scene, zigzag(links, corners.front()), options.masses);
    hold_end(scene, [corners](double t_s) {
        return Pose{along_polygon(corners, t_s, k_hand_speed_mps) + tremor(t_s), Quat::Identity()};
    });
    scene.players_still_until_s = k_never_s;
    return scene;
}

LabScene make_teleport(const SceneOptions& options) {
    LabScene scene;
    const int links = std::max(options.links_or(32), 6);
    const double away = std::min(0.5 * k_link_m * links, 2.0);
    const Vec3 left(away, 0.5, 0.0);
    const Vec3 right(away, -0.5, 0.0);
    add_links(scene, zigzag(links, left), options.masses);
    hold_end(scene, [left, right](double t_s) {
        constexpr double k_rest_s = 0.5;
        const bool even = std::fmod(t_s, 2.0 * k_rest_s) < k_rest_s;
        return Pose{even ? left : right, Quat::Identity()};
    });
    scene.players_still_until_s = k_never_s;
    return scene;
}

LabScene make_ring(const SceneOptions& options) {
    LabScene scene;
    const int links = std::max(options.links_or(32), 3);
    const double radius = 0.5 * k_link_m / std::sin(k_pi / links);
    std::vector<Vec3> places;
    for (int i = 0; i <= links; ++i) {
        const double angle = 2.0 * k_pi * (i % links) / links;
        places.emplace_back(radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
    add_links(scene, places, options.masses);
    // The first joint closes the ring; add_links has made it a joint to the world.
    scene.joints.front().a = links - 1;
    scene.joints.front().frame_a = {Vec3(0.5 * k_link_m, 0.0, 0.0), Quat::Identity()};
    scene.joints.front().frame_b = {Vec3(-0.5 * k_link_m, 0.0, 0.0), Quat::Identity()};
    const Vec3 start = places.front();
    hold_end(scene, [start](double t_s) {
        const std::vector<Vec3> corners = {start, start + Vec3(0.3, 0.0, 0.0), start,
                                           start + Vec3(0.0, 0.3, 0.2)};
        return Pose{along_polygon(corners, t_s, k_hand_speed_mps) + tremor(t_s), Quat::Identity()};
    });
    scene.holds.front().point_only = false;
    scene.players_still_until_s = k_never_s;
    return scene;
}

LabScene make_hub(const SceneOptions& options) {
    LabScene scene;
    const int arms = options.links_or(64);
    constexpr double k_hub_radius = 0.15;
    LabBody hub;
    hub.name = "hub";
    hub.mass_kg = 20.0;
    hub.half_m = Vec3::Constant(0.1);
    scene.add_body(hub);
    for (int i = 0; i < arms; ++i) {
        // Fibonacci sphere: evenly spread directions.
        const double height = 1.0 - (2.0 * i + 1.0) / arms;
        const double angle = k_pi * (3.0 - std::sqrt(5.0)) * i;
        const double flat = std::sqrt(1.0 - height * height);
        const Vec3 out(flat * std::cos(angle), height, flat * std::sin(angle));
        LabJoint joint;
        joint.a = 0;
        joint.b =
            scene.add_body(make_link("arm" + std::to_string(i), link_mass(options.masses, i, arms),
                                     k_hub_radius * out, (k_hub_radius + k_link_m) * out));
        scene.add_joint_at(joint, {k_hub_radius * out, Quat::Identity()});
    }
    scene.players.emplace_back();
    LabHold hold;
    hold.hand_ps = [](double t_s) {
        const std::vector<Vec3> corners = {Vec3(0.0, 0.0, 0.1), Vec3(0.3, 0.0, 0.1),
                                           Vec3(0.0, 0.2, 0.1)};
        const Quat turn = rotation_about(Vec3::UnitY(), triangle_wave(t_s, k_twist_rad, 2.0));
        return Pose{along_polygon(corners, t_s, k_hand_speed_mps) + tremor(t_s), turn};
    };
    scene.add_hold(hold);
    scene.players_still_until_s = k_never_s;
    return scene;
}

}  // namespace handhold::lab
