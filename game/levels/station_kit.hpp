#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "game/levels/station.hpp"

// What the station's sources build with: solids sorted by material, handrails, and chance that is
// the same everywhere.
namespace handhold {

enum class Material {
    hull,
    liner,
    panel,
    accent,
    metal,
    lamp,
    rail,
    cable,
    fabric,
    screen,
    glass,
    dark,
    leaf,
    soil,
    grow,
    solar,
    foil
};
inline constexpr std::size_t k_material_count = 17;

inline constexpr double k_rail_radius_m = 0.0175;
inline constexpr double k_rail_clearance_m = 0.045;  // between bar and wall

struct RimShape {
    double x = 0.0, z = 0.0;            // its middle
    double half_x = 0.1, half_z = 0.1;  // to its outside
    double width = 0.02;                // of the rim
    double y0 = -0.03, y1 = 0.0;        // its foot and its face
};

// Collects the solids of one section (a module, the node) into one mesh a material. A frame handed
// to it has +Y away from the wall and Z along the section.
class StationKit {
  public:
    StationKit(Structure& out, std::string section, const Color& accent);
    // Writes what was collected into the structure. Once, last. Coordinates become the nearest
    // floats: a file of them holds the same station.
    void finish();

    void add(Material material, const Mesh& solid, const Pose& frame);
    // Boxes: on a wall (the edges of its +Y face cut), seen from all sides (all edges cut), and
    // small or hidden (plain).
    void panel(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    void beam(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    void block(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    // The rim of a sunk panel, one piece: an outer box in X and Z with the middle cut out, from y0
    // up to y1.
    void rim(Material material, const Pose& frame, const RimShape& shape);
    // A bar on posts over the wall from `a` to `b` (points on the wall), its ends bent into the
    // wall.
    void handrail(const std::string& name, const Pose& frame, const Vec3& a, const Vec3& b);
    // A round bar swept along the smooth curve (Catmull and Rom 1974) through at least two points.
    void hose(Material material, const Pose& frame, std::span<const Vec3> points, double radius_m);
    // An angle bracket: two sheets of 3 mm, `width_m` along X, one on the wall and one standing on
    // it.
    void bracket(Material material, const Pose& frame, const Vec3& foot, double width_m);
    void lamp(const Vec3& position, const Color& color, double reach_m);
    void spawn(const std::string& name, const Pose& pose);

  private:
    Structure& out_;
    std::string section_;
    std::array<Mesh, k_material_count> meshes_;
};

// Chance from a name: in [0, 1), equal for equal arguments.
double chance(std::size_t a, std::size_t b, std::size_t c);

}  // namespace handhold
