#include "engine/geometry/shape_surface.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// Number of sectors per turn: a multiple of four, so that there are corners on the axes.
std::uint32_t sectors(double step_rad) {
    const double rounded_up = std::ceil(2.0 * k_pi / step_rad / 4.0) * 4.0;
    return static_cast<std::uint32_t>(
        std::clamp(rounded_up, 8.0, static_cast<double>(k_max_sectors)));
}
// The sagitta of a chord over the angle s is r (1 - cos(s / 2)) < r s^2 / 8.
std::uint32_t circle_sectors(double radius_m, double tolerance_m) {
    return sectors(std::sqrt(8.0 * tolerance_m / radius_m));
}
// A face that spans the angle s in both directions deviates by less than twice r s^2 / 8.
std::uint32_t sphere_sectors(double radius_m, double tolerance_m) {
    return sectors(std::sqrt(4.0 * tolerance_m / radius_m));
}

struct ProfilePoint {
    double radius_m = 0.0;
    double y_m = 0.0;
};

// Revolves a profile about the y axis. The profile begins at a point on +y and ends at a point on
// -y.
Mesh turn_profile(const std::vector<ProfilePoint>& profile, std::uint32_t sector_count) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0, profile.front().y_m, 0.0);
    for (std::size_t ring = 1; ring + 1 < profile.size(); ++ring) {
        for (std::uint32_t s = 0; s < sector_count; ++s) {
            double sine = 0.0;
            double cosine = 0.0;
            sin_cos(2.0 * k_pi * s / sector_count, sine, cosine);
            mesh.positions.emplace_back(profile[ring].radius_m * sine, profile[ring].y_m,
                                        profile[ring].radius_m * cosine);
        }
    }
    const auto bottom = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(0.0, profile.back().y_m, 0.0);
    const auto ring_count = static_cast<std::uint32_t>(profile.size() - 2);
    const auto at = [&](std::uint32_t ring, std::uint32_t s) {
        return 1 + ring * sector_count + s % sector_count;
    };
    for (std::uint32_t s = 0; s < sector_count; ++s) {
        mesh.triangles.push_back({0, at(0, s), at(0, s + 1)});
        for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
            mesh.triangles.push_back({at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
            mesh.triangles.push_back({at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
        }
        mesh.triangles.push_back({at(ring_count - 1, s), bottom, at(ring_count - 1, s + 1)});
    }
    return mesh;
}

// Surface of a capsule: a sphere whose halves are 2 * half_height_m apart. A sphere if that is 0.
Mesh capsule_surface(double radius_m, double half_height_m, double tolerance_m) {
    const std::uint32_t around = sphere_sectors(radius_m, tolerance_m);
    const std::uint32_t quarter = around / 4;
    std::vector<ProfilePoint> profile;
    for (std::uint32_t i = 0; i <= 2 * quarter; ++i) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(0.5 * k_pi * i / quarter, sine, cosine);
        if (i == quarter) {
            profile.push_back({radius_m, half_height_m});
            if (half_height_m > 0.0) {
                profile.push_back({radius_m, -half_height_m});
            }
        } else {
            const double side_m = i < quarter ? half_height_m : -half_height_m;
            profile.push_back({radius_m * sine, side_m + radius_m * cosine});
        }
    }
    return turn_profile(profile, around);
}

Mesh cylinder_surface(double radius_m, double half_height_m, double tolerance_m) {
    return turn_profile({{0.0, half_height_m},
                         {radius_m, half_height_m},
                         {radius_m, -half_height_m},
                         {0.0, -half_height_m}},
                        circle_sectors(radius_m, tolerance_m));
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
    return mesh;
}

}  // namespace handhold
