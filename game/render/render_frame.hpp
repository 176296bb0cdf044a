#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/math/math.hpp"

// What one picture shows, as plain data: the renderer's only input besides its meshes. World space
// is double; the renderer subtracts the camera first, so a scene 10 km from the origin looks like
// one at it.
namespace handhold {

using Color = std::array<float, 3>;  // linear RGB

// A mesh given to Renderer::add_mesh.
enum class MeshId : std::uint32_t {};

// How a surface takes light.
struct Look {
    float emissive = 0.0F;  // times the colour, added; 1 is the brightness of a lit white wall,
                            // lamps are at 2 to 4
    float opacity = 1.0F;   // below 1: blended, drawn after all else, casts no shadow
    float gloss = 0.25F;    // 0 chalk .. 1 polished
};

struct Instance {
    MeshId mesh{};
    Pose pose_ws;
    std::optional<Color> color;  // the mesh's own where empty
    Look look;
    bool is_own = false;  // of him whose eyes the camera is: hides ghosts that say so
};

// A straight mark of constant width on the picture (palm rays, constraints): faint where something
// hides it.
struct Line {
    Vec3 a_ws = Vec3::Zero();
    Vec3 b_ws = Vec3::Zero();
    Color color = {1.0F, 0.8F, 0.1F};
    double width_px = 2.5;
};

// A mesh that is not there: what a tracked hand would be, over everything else and through walls.
// Casts no shadow. Its strengths are how much of what is behind it it covers, in [0, 1].
struct Ghost {
    MeshId mesh{};
    Pose pose_ws;
    Color color = {0.35F, 0.75F, 1.0F};
    float seen = 0.5F;            // where nothing hides it
    float hidden = 0.35F;         // where something does,
    double hidden_from_m = 0.0;   // from so far before it on, along the view,
    double hidden_full_m = 0.01;  // wholly from so far; above hidden_from_m
    bool own_hides = false;       // not drawn behind what is_own, where that is seen
};

// A small lamp without shadow. Its light fades to nothing at reach_m, so that it hardly leaks
// through walls.
struct Lamp {
    Vec3 position_ws = Vec3::Zero();
    Color color = {1.0F, 1.0F, 1.0F};  // times intensity at 1 m
    double reach_m = 4.0;              // above 0
};

// The one light with shadows. In a room, caster_reach_m of about 1 m makes it a lamp in the ceiling
// (what is farther towards the light casts nothing); outside, the reach of the scene makes it the
// sun.
struct KeyLight {
    Vec3 towards_ws = Vec3(0.35, 0.9, 0.25);  // not zero
    Color color = {0.50F, 0.47F, 0.43F};
    double caster_reach_m = 1.0;
    double shadow_radius_m = 3.5;  // of the region before the camera where shadows are drawn
};

// The sides of an eye's picture at distance 1 along its -Z: right of the middle and above it are
// positive. left < right, down < up.
struct EyeFrustum {
    double left = -1.0;
    double right = 1.0;
    double down = -1.0;
    double up = 1.0;
};

// The camera looks along its own -Z, +Y is up on the picture.
struct Camera {
    Pose pose_ws;
    double vertical_fov_rad = 1.2;
    std::optional<EyeFrustum> frustum;  // instead of vertical_fov_rad
    double near_m = 0.03;
};

struct UiPicture;  // ui_picture.hpp

// Panels on a sheet that stands in the world, hidden by what is before it: its middle at the pose,
// +Z to whoever reads it, +Y up.
struct Sheet {
    const UiPicture* ui = nullptr;  // must outlive the drawing
    std::array<int, 2> size_px = {1, 1};
    Pose pose_ws;
    double width_m = 0.6;
};

enum class Backdrop { plain, space };  // space: stars, and a planet where planet_ws points

struct RenderFrame {
    Camera camera;
    std::vector<Instance> instances;
    std::vector<Ghost> ghosts;
    std::vector<Line> lines;
    float hidden_lines = 0.22F;  // [0, 1]; how much of a line is seen where something hides it
    std::optional<Sheet> sheet;
    std::vector<Lamp> lamps;  // the twelve that matter most to the camera are used
    KeyLight key;
    Vec3 up_ws = Vec3::UnitY();  // from the ground's ambient light to the sky's
    Color sky_ambient = {0.16F, 0.175F, 0.20F};
    Color ground_ambient = {0.11F, 0.105F, 0.10F};
    float head_light = 0.06F;  // a lamp at the camera: keeps unlit places readable
    float exposure = 1.0F;
    float haze_per_m = 0.010F;  // share of haze a metre of distance
    Color haze = {0.20F, 0.23F, 0.27F};
    Backdrop backdrop = Backdrop::plain;
    Color background = {0.0F, 0.0F, 0.0F};  // of Backdrop::plain, shown as it is: no tone mapping
    Vec3 planet_ws = Vec3(0.25, -0.85, -0.75);  // direction of the planet's centre
};

}  // namespace handhold
