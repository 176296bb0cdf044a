#pragma once

#include <memory>

#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/shape_library.hpp"
#include "systems/match/match_world.hpp"
#include "tools/lab/match_hands.hpp"

// Scenes of `handhold-lab match`.
namespace handhold::lab {

// One machine's copy of a scene: built alike on every machine.
class MatchScene {
  public:
    explicit MatchScene(const MatchSetting& setting);
    MatchScene(const MatchScene&) = delete;
    MatchScene& operator=(const MatchScene&) = delete;

    MatchWorld match(double tick_s);
    const ShapeLibrary& shapes() const { return shapes_; }
    const World& world() const { return world_; }

  private:
    void add_floor();
    void add_pair(PairTask task, std::size_t pair, const Vec3& at_ws);
    void add_free(const std::string& name, ShapeId shape, double mass_kg, const Vec3& at_ws);

    ShapeLibrary shapes_;
    World world_;
    Tuning tuning_;
    GripMeshLibrary grip_meshes_;
    std::unique_ptr<FrameCaches> caches_;
    std::size_t players_;
};

}  // namespace handhold::lab
