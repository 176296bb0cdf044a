#pragma once

#include <cstddef>
#include <vector>

#include "systems/snapshot/snapshot.hpp"
#include "tests/systems/frame/crowd.hpp"

// The world that the snapshot tests save.
namespace handhold::test {

// All players grip, an entity was destroyed, and its slot was reused.
inline Crowd played_crowd() {
    Crowd crowd;
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble3")));
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble5")));
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble4")));
    const ShapeId shape = crowd.shapes.add_sphere(0.1);
    add_body(crowd.world, {"late", {}, {Vec3(0.0, 5.0, 0.0), Quat::Identity()}, {}, shape});
    crowd.drop_caches();
    crowd.run(60);
    return crowd;
}

inline std::vector<std::byte> saved(const Crowd& crowd) {
    std::vector<std::byte> bytes;
    save_snapshot(crowd.world, SnapshotAssets(crowd.shapes), bytes);
    return bytes;
}

}  // namespace handhold::test
