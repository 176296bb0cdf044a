#include "engine/geometry/grip_mesh.hpp"

#include "engine/geometry/shape_surface.hpp"

namespace handhold {

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings) {
    GripMesh grip;
    grip.contact = build_surface_graph(mesh, settings.weld);
    grip.contact_bvh = TriangleBvh(grip.contact.positions, grip.contact.triangles);
    grip.search = grip.contact;
    grip.search_bvh = grip.contact_bvh;
    return grip;
}

GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings) {
    return build_grip_mesh(shape_surface(shape, settings.shape_tolerance_m), settings);
}

}  // namespace handhold
