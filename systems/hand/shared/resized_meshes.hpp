#pragma once

#include <map>
#include <memory>
#include <utility>

#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

// Grip meshes in the metres of hands whose player's scale is not 1 (PlayerOrigin::scale). A cache:
// a mesh depends on its original and the scale alone.
class ResizedMeshes {
  public:
    // `mesh` with lengths over `scale`. Made at the first call, at about 0.2 microseconds a
    // triangle; kept while others than this cache have `mesh`. Not for several threads at once.
    const GripMesh& get(const std::shared_ptr<const GripMesh>& mesh, double scale);

  private:
    struct Entry {
        std::shared_ptr<const GripMesh> original;  // mesh whose address is in the key
        GripMesh resized;
    };
    // Ordered by address and scale. No result depends on the order.
    std::map<std::pair<const GripMesh*, double>, Entry> entries_;
};

}  // namespace handhold
