#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/math/math.hpp"

// Clipping of a box's face by another box's face.
namespace handhold {

// A convex polygon in a box's axes. A face that four sides clip has at most eight corners; with
// rounding, corners in one line may count twice.
struct BoxPolygon {
    std::array<Vec3, 16> corners;
    std::size_t count = 0;

    void add(const Vec3& corner) {
        if (count < corners.size()) {
            corners[count++] = corner;
        }
    }
    // Keeps the part where side * x[axis] <= limit_m.
    void clip(int axis, double side, double limit_m) {
        if (std::none_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count),
                         [&](const Vec3& corner) { return side * corner[axis] > limit_m; })) {
            return;
        }
        const BoxPolygon whole = *this;
        count = 0;
        for (std::size_t k = 0; k < whole.count; ++k) {
            const Vec3& from = whole.corners[k];
            const Vec3& to = whole.corners[k + 1 == whole.count ? 0 : k + 1];
            const double out_from = side * from[axis] - limit_m;
            const double out_to = side * to[axis] - limit_m;
            if (out_from <= 0.0) {
                add(from);
            }
            if ((out_from < 0.0 && out_to > 0.0) || (out_from > 0.0 && out_to < 0.0)) {
                add(from + out_from / (out_from - out_to) * (to - from));
            }
        }
    }
    // Keeps the part above or below the box's face perpendicular to `axis`.
    void clip_to_face(const Vec3& half_m, int axis) {
        for (const int side_axis : {(axis + 1) % 3, (axis + 2) % 3}) {
            clip(side_axis, 1.0, half_m[side_axis]);
            clip(side_axis, -1.0, half_m[side_axis]);
        }
    }
};

// Corners of the face of a box on `side` (1 or -1) of `axis`, in the box's axes, in order around
// the face.
inline std::array<Vec3, 4> box_face(const Vec3& half_m, int axis, double side) {
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
        corners[k] = half_m;
        corners[k][axis] *= side;
        corners[k][(axis + 1) % 3] *= k == 0 || k == 3 ? 1.0 : -1.0;
        corners[k][(axis + 2) % 3] *= k < 2 ? 1.0 : -1.0;
    }
    return corners;
}

}  // namespace handhold
