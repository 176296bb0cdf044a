#pragma once

#include "game/levels/station.hpp"
#include "game/levels/station_description.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

struct ToolModel {
    SceneShape shape;      // box, sphere or capsule around the body's origin
    double mass_kg = 1.0;  // mass of a real tool of this type
    Structure visual;      // closed solids in the body's frame; no rails, lamps or spawns
};
ToolModel make_tool(ToolType type);
const char* tool_type_name(ToolType type);

}  // namespace handhold
