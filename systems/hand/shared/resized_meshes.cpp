#include "systems/hand/shared/resized_meshes.hpp"

namespace handhold {

const GripMesh& ResizedMeshes::get(const std::shared_ptr<const GripMesh>& mesh, double scale) {
    const std::pair key{mesh.get(), scale};
    if (const auto found = entries_.find(key); found != entries_.end()) {
        return found->second.resized;
    }
    // Meshes that are used at several scales outlive their shape until that number falls to one.
    std::erase_if(entries_,
                  [](const auto& entry) { return entry.second.original.use_count() == 1; });
    return entries_.emplace(key, Entry{mesh, resized(*mesh, 1.0 / scale)}).first->second.resized;
}

}  // namespace handhold
