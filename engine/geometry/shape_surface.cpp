#include "engine/geometry/shape_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// The sagitta of a chord over the angle s is r (1 - cos(s / 2)) < r s^2 / 8.
std::uint32_t circle_sectors(double radius_m, double tolerance_m) {
    return sectors_of(std::sqrt(8.0 * tolerance_m / radius_m));
}

Mesh capsule_surface(double radius_m, double half_height_m, double tolerance_m) {
    return turned_mesh(turned_capsule(radius_m, half_height_m,
                                      sectors_of(sphere_step_rad(radius_m, tolerance_m))));
}

Mesh cylinder_surface(double radius_m, double half_height_m, double tolerance_m) {
    return turned_mesh({{{0.0, half_height_m},
                         {radius_m, half_height_m},
                         {radius_m, -half_height_m},
                         {0.0, -half_height_m}},
                        circle_sectors(radius_m, tolerance_m)});
}

Mesh box_surface(const Vec3& half_m) {
    Mesh mesh;
    for (unsigned i = 0; i < 8; ++i) {
        mesh.positions.emplace_back((i & 1U) != 0 ? half_m.x() : -half_m.x(),
                                    (i & 2U) != 0 ? half_m.y() : -half_m.y(),
                                    (i & 4U) != 0 ? half_m.z() : -half_m.z());
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

Mesh hull_surface(const ConvexHull& hull) {
    Mesh mesh;
    mesh.positions = hull.corners;
    for (const HullFace& face : hull.faces) {
        for (std::size_t i = 2; i < face.loop.size(); ++i) {
            mesh.triangles.push_back({face.loop[0], face.loop[i - 1], face.loop[i]});
        }
    }
    return mesh;
}

Mesh compound_surface(const std::vector<PlacedShape>& parts, double tolerance_m) {
    Mesh whole;
    for (const PlacedShape& placed : parts) {
        const Mesh part = shape_surface(placed.shape, tolerance_m);
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        for (const Vec3& position : part.positions) {
            whole.positions.push_back(transform_point(placed.pose, position));
        }
        for (const auto& [a, b, c] : part.triangles) {
            whole.triangles.push_back({first + a, first + b, first + c});
        }
    }
    return whole;
}

}  // namespace

// A multiple of four, so that there are corners on the axes.
std::uint32_t sectors_of(double step_rad) {
    const double rounded_up = std::ceil(2.0 * k_pi / step_rad / 4.0) * 4.0;
    return static_cast<std::uint32_t>(
        std::clamp(rounded_up, 8.0, static_cast<double>(k_max_sectors)));
}

// A face that spans the angle s in both directions deviates by less than twice r s^2 / 8.
double sphere_step_rad(double radius_m, double tolerance_m) {
    return std::sqrt(4.0 * tolerance_m / radius_m);
}

TurnedSurface turned_capsule(double radius_m, double half_height_m, std::uint32_t sectors) {
    const std::uint32_t quarter = sectors / 4;
    TurnedSurface surface{{}, sectors};
    for (std::uint32_t i = 0; i <= 2 * quarter; ++i) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(0.5 * k_pi * i / quarter, sine, cosine);
        if (i == quarter) {
            surface.profile.push_back({radius_m, half_height_m});
            if (half_height_m > 0.0) {
                surface.profile.push_back({radius_m, -half_height_m});
            }
        } else {
            const double side_m = i < quarter ? half_height_m : -half_height_m;
            surface.profile.push_back({radius_m * sine, side_m + radius_m * cosine});
        }
    }
    return surface;
}

Mesh turned_mesh(const TurnedSurface& surface) {
    const TurnedIndex at(surface);
    std::vector<std::array<double, 2>> turns(at.sectors);  // sine, cosine
    for (std::uint32_t s = 0; s < at.sectors; ++s) {
        sin_cos(2.0 * k_pi * s / at.sectors, turns[s][0], turns[s][1]);
    }
    Mesh mesh;
    mesh.positions.reserve(std::size_t{at.bottom_vertex()} + 1);
    mesh.positions.emplace_back(0.0, surface.profile.front().y_m, 0.0);
    for (std::uint32_t ring = 0; ring < at.rings; ++ring) {
        const TurnedSurface::Point& point = surface.profile[ring + 1];
        for (const auto& [sine, cosine] : turns) {
            mesh.positions.emplace_back(point.radius_m * sine, point.y_m, point.radius_m * cosine);
        }
    }
    mesh.positions.emplace_back(0.0, surface.profile.back().y_m, 0.0);
    mesh.triangles.reserve(std::size_t{at.per_sector()} * at.sectors);
    for (std::uint32_t s = 0; s < at.sectors; ++s) {
        mesh.triangles.push_back({0, at.vertex(0, s), at.vertex(0, s + 1)});
        for (std::uint32_t ring = 0; ring + 1 < at.rings; ++ring) {
            mesh.triangles.push_back(
                {at.vertex(ring, s), at.vertex(ring + 1, s), at.vertex(ring + 1, s + 1)});
            mesh.triangles.push_back(
                {at.vertex(ring, s), at.vertex(ring + 1, s + 1), at.vertex(ring, s + 1)});
        }
        mesh.triangles.push_back(
            {at.vertex(at.rings - 1, s), at.bottom_vertex(), at.vertex(at.rings - 1, s + 1)});
    }
    return mesh;
}

Mesh shape_surface(const Shape& shape, double tolerance_m) {
    HH_CHECK(tolerance_m > 0.0, "a tolerance must be above 0", tolerance_m);
    switch (shape.kind) {
        case ShapeKind::box:
            return box_surface(shape.half_m);
        case ShapeKind::sphere:
            return capsule_surface(shape.radius_m, 0.0, tolerance_m);
        case ShapeKind::capsule:
            return capsule_surface(shape.radius_m, shape.half_height_m, tolerance_m);
        case ShapeKind::cylinder:
            return cylinder_surface(shape.radius_m, shape.half_height_m, tolerance_m);
        case ShapeKind::hull:
            return hull_surface(*shape.hull);
        case ShapeKind::compound:
            return compound_surface(*shape.parts, tolerance_m);
        case ShapeKind::mesh:
            break;
    }
    Mesh mesh = *shape.mesh;
    for (Vec3& position : mesh.positions) {
        position = position.cwiseProduct(shape.scale);
    }
    if (is_mirrored(shape.scale)) {
        for (auto& [a, b, c] : mesh.triangles) {
            std::swap(b, c);
        }
    }
    return mesh;
}

}  // namespace handhold
