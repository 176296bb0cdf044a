#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "engine/geometry/shape_library.hpp"

namespace handhold {

// A shape's surface as triangles in the shape's frame, counter-clockwise seen from outside. Meshes
// keep their triangle order, and their winding as seen in the mirror if they are mirrored. Corners
// lie on the true surface, and no point is farther from it than tolerance_m (> 0). Round shapes
// that would need more than k_max_sectors sectors per turn deviate by at most 8e-5 of their radius
// (sphere, capsule: 1.6e-4). Overlapping parts of a compound are kept whole, including the surfaces
// inside other parts.
Mesh shape_surface(const Shape& shape, double tolerance_m);

inline constexpr std::uint32_t k_max_sectors = 256;

// A profile that is revolved about the y axis. It begins at a point on +y and ends at one on -y.
struct TurnedSurface {
    struct Point {
        double radius_m = 0.0;
        double y_m = 0.0;
    };
    std::vector<Point> profile;  // three or more
    std::uint32_t sectors = 0;   // number per turn, a multiple of four
};

// Sectors per turn of a sphere or capsule whose triangles span at most step_rad.
std::uint32_t sectors_of(double step_rad);
// Largest such angle at which no point is farther than tolerance_m (> 0) from the true surface.
double sphere_step_rad(double radius_m, double tolerance_m);
// A sphere whose halves are 2 * half_height_m apart: a sphere if that is 0.
TurnedSurface turned_capsule(double radius_m, double half_height_m, std::uint32_t sectors);

// Triangles of sector s: 0 at the top, then two for each band between rings, from the top, then one
// at the bottom; sectors follow each other. TurnedIndex names them.
Mesh turned_mesh(const TurnedSurface& surface);

struct TurnedIndex {
    std::uint32_t rings;  // number of the profile's points without its two ends; >= 1
    std::uint32_t sectors;

    explicit TurnedIndex(const TurnedSurface& surface)
        : rings(static_cast<std::uint32_t>(surface.profile.size() - 2)), sectors(surface.sectors) {}
    std::uint32_t per_sector() const { return 2 * rings; }
    // The vertex of a ring.
    std::uint32_t vertex(std::uint32_t ring, std::uint32_t s) const {
        return 1 + ring * sectors + s % sectors;
    }
    std::uint32_t bottom_vertex() const { return 1 + rings * sectors; }
    std::uint32_t top(std::uint32_t s) const { return (s % sectors) * per_sector(); }
    std::uint32_t bottom(std::uint32_t s) const { return top(s) + per_sector() - 1; }
    // Between ring `band` and the next one, band < rings - 1: the triangle with two corners on the
    // lower ring, and the one with two corners on the upper ring.
    std::uint32_t lower(std::uint32_t band, std::uint32_t s) const { return top(s) + 1 + 2 * band; }
    std::uint32_t upper(std::uint32_t band, std::uint32_t s) const { return top(s) + 2 + 2 * band; }
};

}  // namespace handhold
