#pragma once

#include <limits>
#include <utility>

#include "tests/engine/collision/scene.hpp"

// Meshes as people make them, from clean ones: each function breaks one thing.
namespace handhold::test {

inline double chance(Random& random) { return random.between(0.0, 1.0); }

// Every triangle with corners of its own, each up to jitter_m off along each axis.
inline Mesh as_soup(const Mesh& mesh, double jitter_m, Random& random) {
    Mesh soup;
    for (const auto& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t corner : triangle) {
            soup.positions.push_back(mesh.positions[corner] + random.vector(jitter_m));
        }
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

inline Mesh with_holes(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    std::erase_if(result.triangles, [&](const auto&) { return chance(random) < share; });
    return result;
}

inline Mesh with_flips(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    for (auto& triangle : result.triangles) {
        if (chance(random) < share) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    return result;
}

// Splits triangles at a point of one edge; the neighbour there stays whole.
inline Mesh with_t_junctions(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
        if (chance(random) < share) {
            const auto [a, b, c] = mesh.triangles[t];
            const auto middle = static_cast<std::uint32_t>(result.positions.size());
            const double along = random.between(0.3, 0.7);
            result.positions.push_back((1.0 - along) * mesh.positions[a] +
                                       along * mesh.positions[b]);
            result.triangles[t] = {a, middle, c};
            result.triangles.push_back({middle, b, c});
        }
    }
    return result;
}

// Splits triangles next to a corner: needles a thousandth as wide as they are long.
inline Mesh with_slivers(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
        if (chance(random) < share) {
            const auto [a, b, c] = mesh.triangles[t];
            const auto inside = static_cast<std::uint32_t>(result.positions.size());
            result.positions.push_back(0.998 * mesh.positions[a] + 0.001 * mesh.positions[b] +
                                       0.001 * mesh.positions[c]);
            result.triangles[t] = {a, b, inside};
            result.triangles.push_back({b, c, inside});
            result.triangles.push_back({c, a, inside});
        }
    }
    return result;
}

// Every triangle a second time, with the other side out.
inline Mesh doubled(const Mesh& mesh) {
    Mesh result = mesh;
    for (const auto& [a, b, c] : mesh.triangles) {
        result.triangles.push_back({a, c, b});
    }
    return result;
}

inline Mesh with_duplicates(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    for (const auto& [a, b, c] : mesh.triangles) {
        if (chance(random) < share) {
            result.triangles.push_back({b, c, a});
        }
    }
    return result;
}

inline Mesh with_wild_vertices(const Mesh& mesh, double share, Random& random) {
    Mesh result = mesh;
    for (Vec3& position : result.positions) {
        if (chance(random) < share) {
            position.y() = chance(random) < 0.5 ? std::numeric_limits<double>::quiet_NaN()
                                                : -std::numeric_limits<double>::infinity();
        }
    }
    return result;
}

// A closed wavy ball without twin vertices or triangles without area.
inline Mesh make_clean_ball(double radius_m, std::uint32_t rings, std::uint32_t sectors) {
    const std::shared_ptr<Mesh> ball = make_wavy_ball(radius_m, rings, sectors);
    const auto place = [&](std::uint32_t v) -> std::uint32_t {
        const std::uint32_t ring = v / (sectors + 1);
        const std::uint32_t sector = v % (sectors + 1) % sectors;
        return ring == 0 || ring == rings ? ring * (sectors + 1) : ring * (sectors + 1) + sector;
    };
    Mesh clean;
    clean.positions = ball->positions;
    for (const auto& triangle : ball->triangles) {
        const std::array<std::uint32_t, 3> t = {place(triangle[0]), place(triangle[1]),
                                                place(triangle[2])};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
            clean.triangles.push_back(t);
        }
    }
    return clean;
}

}  // namespace handhold::test
