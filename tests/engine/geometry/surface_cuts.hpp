#pragma once

#include <cmath>
#include <vector>

#include "disc_oracle.hpp"
#include "engine/geometry/disc_trace.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/surface_graph.hpp"

// Brute-force plane cuts of surfaces, and surfaces to cut.
namespace handhold::test {

// Full detail, so that reference cuts use the same triangles.
inline GripMesh full_mesh(const Mesh& source) {
    GripMeshSettings settings;
    settings.contact.deviation_m = 0.0;
    return build_grip_mesh(source, settings);
}

// The cuts of all triangles that reach into the disc, in triangle order.
inline std::vector<DiscSegment> cut_by_hand(const SurfaceGraph& graph, const Disc& disc) {
    std::vector<DiscSegment> cuts;
    for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
        std::vector<Vec2> ends;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& a = graph.positions[graph.triangles[t][i]];
            const Vec3& b = graph.positions[graph.triangles[t][(i + 1) % 3]];
            const double height_a = disc.normal.dot(a - disc.center);
            const double height_b = disc.normal.dot(b - disc.center);
            if ((height_a >= 0.0) != (height_b >= 0.0)) {
                const Vec3 point = (height_b * a - height_a * b) / (height_b - height_a);
                ends.push_back(to_disc(disc, point));
            }
        }
        if (ends.size() == 2 && point_to_segment(Vec2::Zero(), ends[0], ends[1]) <= disc.radius_m) {
            cuts.push_back({ends[0], ends[1], disc.plane, t});
        }
    }
    return cuts;
}

inline Disc random_disc(const Vec3& center, double radius_m, Random& random) {
    const Quat rotation = random.rotation();
    Disc disc;
    disc.center = center;
    disc.x_axis = rotation * Vec3::UnitX();
    disc.y_axis = rotation * Vec3::UnitY();
    disc.normal = rotation * Vec3::UnitZ();
    disc.radius_m = radius_m;
    return disc;
}

// A torus about the y axis.
inline Mesh make_torus(double ring_m, double tube_m, std::uint32_t around, std::uint32_t across) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = 2.0 * M_PI * i / around;
            const double v = 2.0 * M_PI * j / across;
            const double out_m = ring_m + tube_m * std::cos(v);
            mesh.positions.emplace_back(out_m * std::cos(u), tube_m * std::sin(v),
                                        out_m * std::sin(u));
        }
    }
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const auto corner = [&](std::uint32_t k, std::uint32_t l) {
                return (i + k) % around * across + (j + l) % across;
            };
            mesh.triangles.push_back({corner(0, 0), corner(0, 1), corner(1, 0)});
            mesh.triangles.push_back({corner(1, 0), corner(0, 1), corner(1, 1)});
        }
    }
    return mesh;
}

// A tube about the x axis, open at both ends, wound outward.
inline Mesh make_tube(double radius_m, double length_m, std::uint32_t sectors,
                      std::uint32_t rings) {
    Mesh mesh;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const double angle = 2.0 * M_PI * s / sectors;
            mesh.positions.emplace_back(length_m * (static_cast<double>(r) / rings - 0.5),
                                        radius_m * std::cos(angle), radius_m * std::sin(angle));
        }
    }
    for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const std::uint32_t a = r * sectors + s;
            const std::uint32_t b = r * sectors + (s + 1) % sectors;
            mesh.triangles.push_back({a, b, a + sectors});
            mesh.triangles.push_back({a + sectors, b, b + sectors});
        }
    }
    return mesh;
}

}  // namespace handhold::test
