#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "tests/random.hpp"

// Helpers of the collision tests: small scenes and generated meshes.
namespace handhold::test {

inline Pose at(const Vec3& position, const Quat& rotation = Quat::Identity()) {
    return {position, rotation};
}

inline ColliderProxy resting(std::uint64_t id, ShapeId shape, const Pose& pose, bool free) {
    return {id, shape, pose, pose, free};
}

inline std::vector<ContactPoint> contacts_of(const ShapeLibrary& shapes,
                                             std::vector<ColliderProxy> proxies,
                                             const ContactLimits& limits = {}) {
    std::sort(proxies.begin(), proxies.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    CollisionWorld world(shapes);
    world.set_proxies(proxies);
    std::vector<ContactPoint> contacts;
    world.find_contacts(limits, contacts);
    return contacts;
}

inline double deepest(const std::vector<ContactPoint>& contacts) {
    double lowest = 1e9;
    for (const ContactPoint& contact : contacts) {
        lowest = std::min(lowest, contact.separation_m);
    }
    return lowest;
}

// A floor in the plane y = 0, centred on the origin, of `cells` x `cells` squares with two
// triangles each. Winding: up, down, or alternating.
enum class Winding { up, down, mixed };
inline std::shared_ptr<Mesh> make_floor(double size_m, std::uint32_t cells,
                                        Winding winding = Winding::up) {
    auto mesh = std::make_shared<Mesh>();
    for (std::uint32_t z = 0; z <= cells; ++z) {
        for (std::uint32_t x = 0; x <= cells; ++x) {
            mesh->positions.emplace_back(size_m * (x / static_cast<double>(cells) - 0.5), 0.0,
                                         size_m * (z / static_cast<double>(cells) - 0.5));
        }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const bool flip = winding == Winding::down ||
                          (winding == Winding::mixed && mesh->triangles.size() % 2 == 1);
        mesh->triangles.push_back({a, flip ? c : b, flip ? b : c});
    };
    for (std::uint32_t z = 0; z < cells; ++z) {
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t corner = z * (cells + 1) + x;
            add(corner, corner + cells + 1, corner + 1);
            add(corner + 1, corner + cells + 1, corner + cells + 2);
        }
    }
    return mesh;
}

// Adds a wall of 2 x 1 m to a floor, 0.3 m from its middle, that faces -X.
inline void add_wall(Mesh& floor) {
    const auto base = static_cast<std::uint32_t>(floor.positions.size());
    floor.positions.insert(floor.positions.end(),
                           {{0.3, 0.0, -1.0}, {0.3, 0.0, 1.0}, {0.3, 1.0, 1.0}, {0.3, 1.0, -1.0}});
    floor.triangles.push_back({base, base + 1, base + 2});
    floor.triangles.push_back({base, base + 2, base + 3});
}

// A closed box of 12 triangles with shared vertices.
inline std::shared_ptr<Mesh> make_box_mesh(const Vec3& half_m) {
    auto mesh = std::make_shared<Mesh>();
    for (unsigned i = 0; i < 8; ++i) {
        mesh->positions.emplace_back((i & 1U) != 0 ? half_m.x() : -half_m.x(),
                                     (i & 2U) != 0 ? half_m.y() : -half_m.y(),
                                     (i & 4U) != 0 ? half_m.z() : -half_m.z());
    }
    mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

// A wavy ball of 2 * rings * sectors triangles, centred on the origin; about as dense as a part of
// a level.
inline std::shared_ptr<Mesh> make_wavy_ball(double radius_m, std::uint32_t rings,
                                            std::uint32_t sectors) {
    auto mesh = std::make_shared<Mesh>();
    for (std::uint32_t r = 0; r <= rings; ++r) {
        for (std::uint32_t s = 0; s <= sectors; ++s) {
            double sin_r = 0.0, cos_r = 0.0, sin_s = 0.0, cos_s = 0.0, wave = 0.0, unused = 0.0;
            sin_cos(3.14159265358979 * r / rings, sin_r, cos_r);
            sin_cos(2.0 * 3.14159265358979 * s / sectors, sin_s, cos_s);
            sin_cos(12.0 * 3.14159265358979 * (r / static_cast<double>(rings)), wave, unused);
            mesh->positions.push_back(radius_m * (1.0 + 0.02 * wave) *
                                      Vec3(sin_r * cos_s, cos_r, sin_r * sin_s));
        }
    }
    for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const std::uint32_t corner = r * (sectors + 1) + s;
            mesh->triangles.push_back({corner, corner + 1, corner + sectors + 1});
            mesh->triangles.push_back({corner + 1, corner + sectors + 2, corner + sectors + 1});
        }
    }
    return mesh;
}

}  // namespace handhold::test
