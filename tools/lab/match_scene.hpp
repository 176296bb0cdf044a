#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/shape_library.hpp"
#include "systems/match/match_world.hpp"

// Scenes of `handhold-lab match`, and the hands of their players.
namespace handhold::lab {

std::vector<std::string_view> match_scene_names();

// One machine's copy of a scene: built alike on every machine.
// "crawl": players crawl over a floor with loose rocks, gripping and letting go all the time.
// "bars": the players of each pair pull one loose bar with a hand each, and wave the other.
class MatchScene {
  public:
    MatchScene(std::string_view name, std::size_t players);
    MatchScene(const MatchScene&) = delete;
    MatchScene& operator=(const MatchScene&) = delete;

    MatchWorld match(double tick_s);
    const ShapeLibrary& shapes() const { return shapes_; }
    const World& world() const { return world_; }

  private:
    ShapeLibrary shapes_;
    World world_;
    Tuning tuning_;
    GripMeshLibrary grip_meshes_;
    std::unique_ptr<FrameCaches> caches_;
    std::size_t players_;
};

// A player's devices at a time of the match. Hands tremble by 0.3 mm, as people's do.
TrackingSample devices_at(std::string_view scene, std::size_t player, double t_s);

}  // namespace handhold::lab
