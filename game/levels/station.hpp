#pragma once

#include <string>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "game/mesh/render_frame.hpp"

// The station, built from a description (docs/reference/station_format.md), and the ship, a
// platform that is built in code. Lengths in metres. The meshes are also colliders, so they must be
// equal on every machine, bit for bit.
namespace handhold {

// The straight part of a handrail, along its axis.
struct HandrailSpan {
    std::string name;  // "<section>/<rail>", such as "hab/left_upper"
    Vec3 start = Vec3::Zero();
    Vec3 end = Vec3::Zero();
    double radius_m = 0.0175;
};

struct SpawnPoint {
    std::string name;
    Pose pose;  // pose of the head, which looks along -Z; at least 0.3 m from every surface
};

// Meshes in one frame. Each part is made of closed solids of one material, is welded, and is named
// "<section>/<material>". Solids may touch or intersect each other.
struct Structure {
    std::vector<Mesh> parts;
    std::vector<Look> looks;  // one for each part
    std::vector<HandrailSpan> rails;
    std::vector<SpawnPoint> spawns;
    std::vector<Lamp> lamps;
};

struct StationDescription;  // game/levels/station_description.hpp

// The station in the frame of its description. It is static. Its coordinates are exactly
// representable as floats.
Structure make_station(const StationDescription& description);
// The station of game/assets/station.json. The node's centre is the origin; the habitat is towards
// +Z, the laboratory towards -X, the airlock towards +X, the cupola towards -Z, the truss above.
Structure make_station();
// The rails of the game's station, for scripts that plan along them.
std::vector<HandrailSpan> station_rails();

// An open shuttle-like platform of about 8 m (along Z) x 3 m x 4 m: deck, wall, roof over its rear
// half, rails. In its body's frame: origin in the middle, -Z forward.
Structure make_ship();

// The visual of a rock of about 16 cm, without a collider.
Mesh make_held_rock();

}  // namespace handhold
