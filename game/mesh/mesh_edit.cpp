#include "game/mesh/mesh_edit.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace handhold {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

}  // namespace

void append(Mesh& into, const Mesh& part, const Pose& at) {
    const std::uint32_t first = index_of(into.positions.size());
    for (const Vec3& point : part.positions) {
        into.positions.push_back(transform_point(at, point));
    }
    for (const Triangle& t : part.triangles) {
        into.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
}

void mirror_x(Mesh& mesh) {
    for (Vec3& point : mesh.positions) {
        point.x() = -point.x();
    }
    for (Triangle& t : mesh.triangles) {
        std::swap(t[1], t[2]);
    }
}

void stretch(Mesh& mesh, const Vec3& factors) {
    for (Vec3& point : mesh.positions) {
        point = point.cwiseProduct(factors);
    }
}

void weld(Mesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> places;
    std::vector<Vec3> kept;
    for (Triangle& t : mesh.triangles) {
        for (std::uint32_t& corner : t) {
            const Vec3& p = mesh.positions[corner];
            const auto [at, is_new] =
                places.try_emplace({p.x(), p.y(), p.z()}, index_of(kept.size()));
            if (is_new) {
                kept.push_back(p);
            }
            corner = at->second;
        }
    }
    mesh.positions = std::move(kept);
}

}  // namespace handhold
