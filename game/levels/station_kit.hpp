#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "game/levels/station.hpp"

// Building blocks of the station: solids sorted by material, handrails, and reproducible random
// numbers.
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
inline constexpr double k_rail_clearance_m = 0.045;  // gap between bar and wall

struct RimShape {
    double x = 0.0, z = 0.0;            // centre
    double half_x = 0.1, half_z = 0.1;  // distances from the centre to the outer edge
    double width = 0.02;                // width of the rim
    double y0 = -0.03, y1 = 0.0;        // height of its foot and of its face
};

// Collects the solids of one section (a module, the node) into one mesh for each material. In every
// `frame`, +Y points away from the wall and Z along the section.
class StationKit {
  public:
    StationKit(Structure& out, std::string section, const Color& accent);
    // Writes the collected solids into the structure; call it once, last. Rounds coordinates to
    // floats, so a saved station loads unchanged.
    void finish();

    void add(Material material, const Mesh& solid, const Pose& frame);
    // Boxes. panel: on a wall, with the edges of its +Y face bevelled. beam: all edges bevelled.
    // block: no bevels, for small or hidden parts.
    void panel(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    void beam(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    void block(Material material, const Pose& frame, const Vec3& center, const Vec3& half_m);
    // The rim of a recessed panel in one piece: an outer box in X and Z with the middle cut out,
    // from y0 up to y1.
    void rim(Material material, const Pose& frame, const RimShape& shape);
    // A bar on posts along a wall from `a` to `b` (points on the wall). The bar's ends bend into
    // the wall.
    void handrail(const std::string& name, const Pose& frame, const Vec3& a, const Vec3& b);
    // A circle swept along a smooth curve (Catmull and Rom 1974) through at least two points.
    void hose(Material material, const Pose& frame, std::span<const Vec3> points, double radius_m);
    // An angle bracket of two 3 mm sheets, `width_m` along X: one on the wall, one perpendicular to
    // it.
    void bracket(Material material, const Pose& frame, const Vec3& foot, double width_m);
    void lamp(const Vec3& position, const Color& color, double reach_m);
    void spawn(const std::string& name, const Pose& pose);

  private:
    Structure& out_;
    std::string section_;
    std::array<Mesh, k_material_count> meshes_;
};

// A hash of the arguments as a number in [0, 1).
double chance(std::size_t a, std::size_t b, std::size_t c);

}  // namespace handhold
