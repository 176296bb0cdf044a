#include <cmath>

#include <meshoptimizer.h>

#include "engine/geometry/simplify.hpp"

namespace handhold {
namespace {

// Input of meshoptimizer. This version cannot lock vertices, but it keeps vertices at which two or
// more open edges begin. So each locked point gets two extra triangles, which are removed from the
// result.
struct LibraryMesh {
    std::vector<float> points;
    std::vector<unsigned> indices;
};

// Distinct quasirandom points in the unit box (Roberts, The Unreasonable Effectiveness of
// Quasirandom Sequences, 2018).
Vec3 scattered(std::size_t i) {
    const auto fraction = [&](double step) -> double {
        const double x = static_cast<double>(i + 1) * step;
        return x - std::floor(x);
    };
    return {fraction(0.8191725133961645), fraction(0.6710436067037893),
            fraction(0.5497004779019703)};
}

LibraryMesh make_library_mesh(const SimplifyInput& input) {
    LibraryMesh mesh;
    // Positions are floats relative to the first point. meshoptimizer scales its input to a unit
    // box.
    const Vec3 origin = input.positions[0];
    const auto add_point = [&](const Vec3& point) {
        for (const double coordinate : Vec3(point - origin)) {
            mesh.points.push_back(static_cast<float>(coordinate));
        }
    };
    Vec3 low = origin;
    Vec3 high = origin;
    for (const Vec3& position : input.positions) {
        add_point(position);
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    for (const auto& triangle : input.triangles) {
        mesh.indices.insert(mesh.indices.end(), triangle.begin(), triangle.end());
    }
    auto next = static_cast<unsigned>(input.positions.size());
    for (std::size_t i = 0; i < 2 * input.locked.size(); ++i) {
        for (const std::size_t end : {2 * i, 2 * i + 1}) {
            add_point(low + scattered(end).cwiseProduct(high - low));
        }
        mesh.indices.insert(mesh.indices.end(), {input.locked[i / 2], next, next + 1});
        next += 2;
    }
    return mesh;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> simplify(const SimplifyInput& input, double error_m,
                                                   std::size_t least_triangles) {
    if (input.triangles.empty()) {
        return {};
    }
    const LibraryMesh mesh = make_library_mesh(input);
    constexpr std::size_t k_stride = 3 * sizeof(float);
    const std::size_t point_count = mesh.points.size() / 3;
    const float scale = meshopt_simplifyScale(mesh.points.data(), point_count, k_stride);
    if (!(scale > 0.0F)) {
        return {input.triangles.begin(), input.triangles.end()};
    }
    std::vector<unsigned> result(mesh.indices.size());
    result.resize(meshopt_simplify(result.data(), mesh.indices.data(), mesh.indices.size(),
                                   mesh.points.data(), point_count, k_stride,
                                   3 * (least_triangles + 2 * input.locked.size()),
                                   static_cast<float>(error_m) / scale, 0, nullptr));
    std::vector<std::array<std::uint32_t, 3>> simplified;
    for (std::size_t i = 0; i + 2 < result.size(); i += 3) {
        if (result[i] < input.positions.size() && result[i + 1] < input.positions.size() &&
            result[i + 2] < input.positions.size()) {
            simplified.push_back({result[i], result[i + 1], result[i + 2]});
        }
    }
    return simplified;
}

}  // namespace handhold
