#include "engine/geometry/grip_mesh.hpp"

#include <bit>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/geometry/graph_links.hpp"
#include "engine/geometry/round_grip_mesh.hpp"
#include "engine/geometry/shape_surface.hpp"

namespace handhold {
namespace {

double size_of(const SurfaceGraph& graph) {
    if (graph.positions.empty()) {
        return 0.0;
    }
    Vec3 low = graph.positions[0];
    Vec3 high = low;
    for (const Vec3& position : graph.positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    return (high - low).norm();
}

std::size_t memory_bytes(const SurfaceGraph& graph) {
    constexpr std::size_t k_per_triangle =
        2 * sizeof(graph.triangles[0]) + sizeof(Vec3) + sizeof(graph.source_triangle[0]);
    return graph.positions.size() * sizeof(Vec3) + graph.triangles.size() * k_per_triangle;
}

}  // namespace

// One multiplication for each word. HashStream has four, and large meshes have many words.
std::uint64_t digest_of(const SurfaceGraph& contact) {
    std::uint64_t digest = contact.positions.size();
    const auto add = [&digest](std::uint64_t word) {
        digest = (std::rotl(digest, 5) ^ word) * 0x9e3779b97f4a7c15ULL;
    };
    for (const Vec3& position : contact.positions) {
        for (int axis = 0; axis < 3; ++axis) {
            add(std::bit_cast<std::uint64_t>(position[axis]));
        }
    }
    for (const auto& [a, b, c] : contact.triangles) {
        add((std::uint64_t{a} << 32U) | b);
        add(c);
    }
    return mix64(digest);
}

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings) {
    GripMesh grip;
    SurfaceGraph full = build_surface_graph(mesh, settings.weld);
    grip.full_triangles = static_cast<std::uint32_t>(full.triangles.size());
    grip.turned = orient_consistently(full);
    if (size_of(full) < settings.flip_below_m) {
        grip.turned += orient_outward(full);
    }
    // The search detail is simplified from the contact detail, so its limits are relative to that.
    grip.contact = std::move(full);
    if (settings.contact.deviation_m > 0.0) {
        SurfaceGraph coarse = simplify_surface(grip.contact, settings.contact);
        const double max_triangles =
            settings.contact_share * static_cast<double>(grip.full_triangles);
        if (static_cast<double>(coarse.triangles.size()) <= max_triangles) {
            grip.contact = std::move(coarse);
        }
    }
    grip.contact_bvh = TriangleBvh(grip.contact.positions, grip.contact.triangles);
    grip.search = simplify_surface(grip.contact, settings.search, &grip.contact_bvh);
    grip.search_bvh = TriangleBvh(grip.search.positions, grip.search.triangles);
    grip.digest = digest_of(grip.contact);
    return grip;
}

GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings) {
    if (shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule) {
        return build_round_grip_mesh(shape, settings);
    }
    GripMeshSettings own = settings;
    if (shape.kind != ShapeKind::mesh) {
        own.contact.deviation_m = 0.0;
        own.weld.seam_m = own.weld.seam_per_size = 0.0;  // tessellated surfaces are closed
    }
    return build_grip_mesh(shape_surface(shape, settings.shape_tolerance_m), own);
}

GripMesh resized(const GripMesh& grip, double factor) {
    GripMesh result;
    result.turned = grip.turned;
    result.full_triangles = grip.full_triangles;
    HashStream stream;
    stream.add(grip.digest);
    stream.add(factor);
    result.digest = stream.value();
    const auto resize = [factor](const SurfaceGraph& from, const TriangleBvh& from_bvh,
                                 SurfaceGraph& to, TriangleBvh& to_bvh) {
        to = from;
        for (Vec3& position : to.positions) {
            position *= factor;
        }
        const std::vector<std::uint32_t> order = from_bvh.leaf_order();
        to_bvh = TriangleBvh(to.positions, to.triangles, {order, to.normals});
    };
    resize(grip.contact, grip.contact_bvh, result.contact, result.contact_bvh);
    resize(grip.search, grip.search_bvh, result.search, result.search_bvh);
    return result;
}

std::size_t memory_bytes(const GripMesh& grip) {
    return memory_bytes(grip.contact) + grip.contact_bvh.memory_bytes() +
           memory_bytes(grip.search) + grip.search_bvh.memory_bytes();
}

}  // namespace handhold
