#include <meshoptimizer.h>

#include "engine/geometry/simplify.hpp"

namespace handhold {

std::vector<std::array<std::uint32_t, 3>> simplify(
    std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
    double error_m, std::size_t least_triangles) {
    if (triangles.empty()) {
        return {};
    }
    // Floats about the first point: the library scales what it gets to a unit box.
    std::vector<float> points;
    points.reserve(3 * positions.size());
    for (const Vec3& position : positions) {
        for (const double coordinate : Vec3(position - positions[0])) {
            points.push_back(static_cast<float>(coordinate));
        }
    }
    std::vector<unsigned> indices;
    indices.reserve(3 * triangles.size());
    for (const auto& triangle : triangles) {
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    constexpr std::size_t k_stride = 3 * sizeof(float);
    const float scale = meshopt_simplifyScale(points.data(), positions.size(), k_stride);
    if (!(scale > 0.0F)) {
        return {triangles.begin(), triangles.end()};
    }
    std::vector<unsigned> result(indices.size());
    result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), points.data(),
                                   positions.size(), k_stride, 3 * least_triangles,
                                   static_cast<float>(error_m) / scale, 0, nullptr));
    std::vector<std::array<std::uint32_t, 3>> simplified;
    for (std::size_t i = 0; i + 2 < result.size(); i += 3) {
        simplified.push_back({result[i], result[i + 1], result[i + 2]});
    }
    return simplified;
}

}  // namespace handhold
