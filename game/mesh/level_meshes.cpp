#include "game/mesh/level_meshes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace handhold {
namespace {

// Copies the triangles from `first` up to `end`. `places`: for each vertex of `from`, its index in
// `to`.
void copy_run(const Mesh& from, std::size_t first, std::size_t end, Mesh& to,
              std::vector<std::uint32_t>& places) {
    constexpr std::uint32_t k_not_copied = std::numeric_limits<std::uint32_t>::max();
    places.resize(from.positions.size(), k_not_copied);
    for (std::size_t t = first; t < end; ++t) {
        std::array<std::uint32_t, 3> triangle = from.triangles[t];
        for (std::uint32_t& corner : triangle) {
            std::uint32_t& place = places[corner];
            if (place == k_not_copied) {
                place = static_cast<std::uint32_t>(to.positions.size());
                to.positions.push_back(from.positions[corner]);
            }
            corner = place;
        }
        to.triangles.push_back(triangle);
    }
}

}  // namespace

std::vector<LevelMesh> make_level_meshes(const GltfLevel& level) {
    std::vector<LevelMesh> meshes;
    for (const LevelPart& part : level.parts) {
        std::map<std::array<float, 6>, std::size_t> mesh_of_color;
        std::vector<std::vector<std::uint32_t>> places;
        const std::size_t first_mesh = meshes.size();
        for (std::size_t run = 0; run < part.color_runs.size(); ++run) {
            const ColorRun& colors = part.color_runs[run];
            const std::array<float, 6> surface = {colors.color[0], colors.color[1], colors.color[2],
                                                  colors.emissive, colors.opacity,  colors.gloss};
            const auto [at, is_new] =
                mesh_of_color.try_emplace(surface, meshes.size() - first_mesh);
            if (is_new) {
                meshes.push_back({{part.mesh.name, {}, {}, colors.color},
                                  {colors.emissive, colors.opacity, colors.gloss}});
                places.emplace_back();
            }
            const std::size_t end = run + 1 < part.color_runs.size()
                                        ? part.color_runs[run + 1].first_triangle
                                        : part.mesh.triangles.size();
            copy_run(part.mesh, colors.first_triangle, end, meshes[first_mesh + at->second].mesh,
                     places[at->second]);
        }
    }
    return meshes;
}

}  // namespace handhold
