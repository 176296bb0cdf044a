#include "game/mesh/shading_mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "engine/core/hash.hpp"

namespace handhold {
namespace {

constexpr double k_smooth_cosine = 0.81915204428899178968;  // cosine of 35 degrees

struct Corner {
    Vec3 normal;  // unit, of the corner's triangle
    double angle_rad;
};

std::uint64_t place_key(const Vec3& p) {
    HashStream hash;
    for (int axis = 0; axis < 3; ++axis) {
        hash.add(p[axis] + 0.0);  // -0.0 and 0.0 are the same position
    }
    return hash.value();
}

// Mean normal of the triangles at one position that are within the smoothing angle of `own`,
// weighted by the triangles' corner angles. Triangles of the opposite winding count as flipped.
Vec3 smooth_normal(const std::vector<Corner>& around, const Vec3& own) {
    Vec3 sum = Vec3::Zero();
    for (const Corner& corner : around) {
        const double cosine = corner.normal.dot(own);
        if (std::abs(cosine) >= k_smooth_cosine) {
            sum += (cosine < 0.0 ? -corner.angle_rad : corner.angle_rad) * corner.normal;
        }
    }
    const double length = sum.norm();
    return length > 0.0 ? Vec3(sum / length) : own;
}

double angle_between(const Vec3& a, const Vec3& b) {
    return arc_tangent2(a.cross(b).norm(), a.dot(b));
}

void find_bounds(const Mesh& mesh, ShadingMesh& out) {
    Vec3 low = Vec3::Constant(HUGE_VAL);
    Vec3 high = -low;
    for (const Vec3& p : mesh.positions) {
        if (is_finite(p)) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    if (!is_finite(low)) {
        return;
    }
    out.center = 0.5 * (low + high);
    for (const Vec3& p : mesh.positions) {
        if (is_finite(p)) {
            out.radius_m = std::max(out.radius_m, (p - out.center).norm());
        }
    }
}

}  // namespace

ShadingMesh make_shading_mesh(const Mesh& mesh) {
    ShadingMesh out;
    find_bounds(mesh, out);
    std::unordered_map<std::uint64_t, std::uint32_t> place_ids;
    std::vector<std::uint32_t> place_of(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        place_of[i] = place_ids
                          .try_emplace(place_key(mesh.positions[i]),
                                       static_cast<std::uint32_t>(place_ids.size()))
                          .first->second;
    }
    std::vector<std::vector<Corner>> around(place_ids.size());
    std::vector<Vec3> normals(mesh.triangles.size(), Vec3::Zero());  // zero: triangle dropped
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& corners = mesh.triangles[t];
        const Vec3& a = mesh.positions[corners[0]];
        const Vec3& b = mesh.positions[corners[1]];
        const Vec3& c = mesh.positions[corners[2]];
        const Vec3 cross = (b - a).cross(c - a);
        const double length = cross.norm();
        if (!(length > 0.0) || !std::isfinite(length)) {
            continue;
        }
        normals[t] = cross / length;
        around[place_of[corners[0]]].push_back({normals[t], angle_between(b - a, c - a)});
        around[place_of[corners[1]]].push_back({normals[t], angle_between(c - b, a - b)});
        around[place_of[corners[2]]].push_back({normals[t], angle_between(a - c, b - c)});
    }
    std::unordered_map<std::uint64_t, std::uint32_t> vertex_ids;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (normals[t].isZero(0.0)) {
            continue;
        }
        for (const std::uint32_t corner : mesh.triangles[t]) {
            const Eigen::Vector3f normal =
                smooth_normal(around[place_of[corner]], normals[t]).cast<float>();
            HashStream key;
            key.add(std::uint64_t{place_of[corner]});
            for (int axis = 0; axis < 3; ++axis) {
                key.add(std::uint64_t{std::bit_cast<std::uint32_t>(normal[axis])});
            }
            const auto [at, is_new] = vertex_ids.try_emplace(
                key.value(), static_cast<std::uint32_t>(out.vertices.size() / 6));
            if (is_new) {
                const Eigen::Vector3f point = (mesh.positions[corner] - out.center).cast<float>();
                out.vertices.insert(out.vertices.end(), {point.x(), point.y(), point.z(),
                                                         normal.x(), normal.y(), normal.z()});
            }
            out.indices.push_back(at->second);
        }
    }
    return out;
}

}  // namespace handhold
