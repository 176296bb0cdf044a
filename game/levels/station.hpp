#pragma once

#include <string>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "game/render/render_frame.hpp"

// The game's own level, made from a description (docs/reference/station_format.md), and, in code,
// the platform that flies past. Lengths in metres. The meshes are colliders too, so they are equal
// on every machine.
namespace handhold {

// The straight part of a handrail, along its axis.
struct HandrailSpan {
    std::string name;  // "hab/left_upper"
    Vec3 start = Vec3::Zero();
    Vec3 end = Vec3::Zero();
    double radius_m = 0.0175;
};

struct SpawnPoint {
    std::string name;
    Pose pose;  // of the head: -Z looks ahead; at least 0.3 m clear of every surface
};

// A thing built of parts, all in one frame. Each part is welded and made of closed solids (one
// material each, named
// "<section>/<material>"); solids may touch or sink into each other.
struct Structure {
    std::vector<Mesh> parts;
    std::vector<Look> looks;  // one a part
    std::vector<HandrailSpan> rails;
    std::vector<SpawnPoint> spawns;
    std::vector<Lamp> lamps;
};

struct StationDescription;  // game/levels/station_description.hpp

// Static; its frame is that of the description. Coordinates are exact floats.
Structure make_station(const StationDescription& description);
// The game's own: the node's centre is the origin, the habitat lies towards +Z, the laboratory and
// what is beyond it -X, the airlock +X, the cupola -Z, the truss above.
Structure make_station();
// The station's rails alone, for scripts that plan along them.
std::vector<HandrailSpan> station_rails();

// An open shuttle-like platform of about 8 m (along Z) x 3 m x 4 m: deck, wall, roof over its rear
// half, rails. In its body's frame: the origin in the middle, -Z ahead.
Structure make_ship();

// A rock of about 16 cm across, to be seen; its collider is the caller's choice.
Mesh make_held_rock();

}  // namespace handhold
