#pragma once

#include <cmath>
#include <cstdint>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh.hpp"
#include "tests/random.hpp"

// Random triangles without connectivity.
namespace handhold::test {

inline Corners corners_of(const Mesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

// Triangles of sizes from 0.001 to 1, including slivers, lines and points.
inline Mesh make_soup(Random& random, std::size_t count) {
    Mesh mesh;
    for (std::size_t t = 0; t < count; ++t) {
        const double size = std::pow(10.0, random.between(-3.0, 0.0));
        const Vec3 centre = random.vector(1.0);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        Vec3 a = random.vector(size);
        Vec3 b = random.vector(size);
        Vec3 c = random.vector(size);
        const double kind = random.between(0.0, 1.0);
        if (kind < 0.1) {
            c = a + random.between(0.0, 1.0) * (b - a);
            c += random.vector(std::pow(10.0, random.between(-13.0, -6.0)));
        } else if (kind < 0.12) {
            b = c = a;
        }
        for (const Vec3& corner : {a, b, c}) {
            mesh.positions.push_back(centre + corner);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

}  // namespace handhold::test
