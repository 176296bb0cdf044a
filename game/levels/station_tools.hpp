#pragma once

#include "game/levels/station.hpp"
#include "game/levels/station_description.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

struct ToolModel {
    SceneShape shape;      // box, sphere or capsule, about the middle
    double mass_kg = 1.0;  // of a real one
    Structure visual;      // in the body's frame, closed solids; no rails, lamps or spawns
};
ToolModel make_tool(ToolType type);
const char* tool_type_name(ToolType type);

}  // namespace handhold
