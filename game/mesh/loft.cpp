#include "game/mesh/loft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/core/check.hpp"
#include "game/mesh/mesh_edit.hpp"

namespace handhold {
namespace {

// Adds the triangles between two rings, each given by its first vertex and its number of points.
// Either ring may be a single point.
void add_band(Mesh& mesh, std::pair<std::uint32_t, std::size_t> low,
              std::pair<std::uint32_t, std::size_t> high) {
    const std::size_t count = std::max(low.second, high.second);
    for (std::size_t j = 0; j < count; ++j) {
        const std::uint32_t here = index_of(j);
        const std::uint32_t next = index_of((j + 1) % count);
        if (low.second == 1) {
            mesh.triangles.push_back({low.first, high.first + next, high.first + here});
        } else if (high.second == 1) {
            mesh.triangles.push_back({low.first + here, low.first + next, high.first});
        } else {
            mesh.triangles.push_back({low.first + here, low.first + next, high.first + next});
            mesh.triangles.push_back({low.first + here, high.first + next, high.first + here});
        }
    }
}

Vec3 mean_of(const Ring& ring) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& point : ring) {
        sum += point;
    }
    return sum / static_cast<double>(ring.size());
}

}  // namespace

Mesh make_loft(std::span<const Ring> rings, LoftEnds ends) {
    HH_CHECK(rings.size() >= 2, "a loft needs two rings", rings.size());
    Mesh mesh;
    std::vector<std::pair<std::uint32_t, std::size_t>> bands;
    const auto add_ring = [&](const Ring& ring) {
        bands.emplace_back(index_of(mesh.positions.size()), ring.size());
        mesh.positions.insert(mesh.positions.end(), ring.begin(), ring.end());
    };
    const bool is_capped = ends == LoftEnds::capped;
    if (is_capped && rings.front().size() > 1) {
        add_ring({mean_of(rings.front())});
    }
    for (const Ring& ring : rings) {
        add_ring(ring);
    }
    if (is_capped && rings.back().size() > 1) {
        add_ring({mean_of(rings.back())});
    }
    for (std::size_t i = 0; i + 1 < bands.size(); ++i) {
        add_band(mesh, bands[i], bands[i + 1]);
    }
    if (!is_capped) {
        add_band(mesh, bands.back(), bands.front());
    }
    return mesh;
}

Ring make_outline(const RoundedRect& rect, double z_m) {
    HH_CHECK(rect.corner_m < std::min(rect.half_x_m, rect.half_y_m), "corner too wide",
             rect.corner_m);
    const double inner_x = rect.half_x_m - rect.corner_m;
    const double inner_y = rect.half_y_m - rect.corner_m;
    constexpr std::array<std::array<double, 2>, 4> k_corners = {
        {{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}};
    Ring corners;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const Vec3 centre(k_corners[corner][0] * inner_x, k_corners[corner][1] * inner_y, z_m);
        for (int step = 0; step <= rect.corner_steps; ++step) {
            double sine = 0.0;
            double cosine = 1.0;
            sin_cos(
                0.25 * k_two_pi *
                    (static_cast<double>(corner) + step / static_cast<double>(rect.corner_steps)),
                sine, cosine);
            corners.emplace_back(centre + rect.corner_m * Vec3(cosine, sine, 0.0));
        }
    }
    Ring outline;
    const auto arc = static_cast<std::size_t>(rect.corner_steps) + 1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& here = corners[i];
        const Vec3& next = corners[(i + 1) % corners.size()];
        const int steps = i % arc == arc - 1 ? rect.side_steps : 1;
        for (int step = 0; step < steps; ++step) {
            outline.emplace_back(here + (next - here) * (step / static_cast<double>(steps)));
        }
    }
    return outline;
}

Ring round_outline(const Ring& outline, double radius_m) {
    Ring circle = outline;
    for (Vec3& point : circle) {
        const double scale = radius_m / std::sqrt(point.x() * point.x() + point.y() * point.y());
        point = Vec3(scale * point.x(), scale * point.y(), point.z());
    }
    return circle;
}

Ring at_height(Ring ring, double z_m) {
    for (Vec3& point : ring) {
        point.z() = z_m;
    }
    return ring;
}

Mesh make_revolved(std::span<const ProfilePoint> profile, int segments) {
    std::vector<Ring> rings;
    for (const ProfilePoint& point : profile) {
        Ring ring;
        const int count = point.radius_m > 0.0 ? segments : 1;
        for (int j = 0; j < count; ++j) {
            double sine = 0.0;
            double cosine = 1.0;
            sin_cos(k_two_pi * j / segments, sine, cosine);
            ring.emplace_back(point.radius_m * cosine, point.radius_m * sine, point.z_m);
        }
        rings.push_back(std::move(ring));
    }
    return make_loft(rings, LoftEnds::capped);
}

}  // namespace handhold
