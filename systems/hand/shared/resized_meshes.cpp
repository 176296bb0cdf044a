#include "systems/hand/shared/resized_meshes.hpp"

namespace handhold {

const GripMesh& ResizedMeshes::get(const std::shared_ptr<const GripMesh>& mesh, double scale) {
    const std::pair key{mesh.get(), scale};
    const auto found = entries_.find(key);
    if (found != entries_.end() && !found->second.original.expired()) {
        return found->second.resized;
    }
    std::erase_if(entries_, [](const auto& entry) { return entry.second.original.expired(); });
    return entries_.emplace(key, Entry{mesh, resized(*mesh, 1.0 / scale)}).first->second.resized;
}

}  // namespace handhold
