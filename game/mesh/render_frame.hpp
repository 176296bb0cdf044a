#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/math/math.hpp"

// The content of one picture as plain data: the renderer's only input besides its meshes. World
// space is double; the renderer subtracts the camera first, so a scene 10 km from the origin looks
// the same as one at the origin.
namespace handhold {

using Color = std::array<float, 3>;  // linear RGB

// Identifies a mesh that was added with Renderer::add_mesh.
enum class MeshId : std::uint32_t {};

// How a surface reflects and emits light.
struct Look {
    // Multiple of the colour that is added to the reflected light. 1: as bright as a lit white
    // wall; lamps have 2 to 4.
    float emissive = 0.0F;
    float opacity = 1.0F;  // less than 1: blended, drawn after opaque surfaces, casts no shadow
    float gloss = 0.25F;   // 0 chalk .. 1 polished
};

struct Instance {
    MeshId mesh{};
    Pose pose_ws;
    std::optional<Color> color;  // nullopt: the mesh's own
    Look look;
    bool is_own = false;  // belongs to the player whose eyes the camera is at; see Ghost::own_hides
};

// A straight line of constant width in pixels (palm rays, constraints); drawn faintly behind
// geometry.
struct Line {
    Vec3 a_ws = Vec3::Zero();
    Vec3 b_ws = Vec3::Zero();
    Color color = {1.0F, 0.8F, 0.1F};
    double width_px = 2.5;
};

// A transparent mesh that shows a tracked hand's pose, drawn over the scene and through walls.
// Casts no shadow. Strengths are opacities in [0, 1].
struct Ghost {
    MeshId mesh{};
    Pose pose_ws;
    Color color = {0.35F, 0.75F, 1.0F};
    float seen = 0.5F;            // where visible
    float hidden = 0.35F;         // where geometry hides it
    double hidden_from_m = 0.0;   // distance behind the geometry where `hidden` starts to apply
    double hidden_full_m = 0.01;  // distance where it applies fully; above hidden_from_m
    // True: the ghost is not drawn where an instance with is_own is in front of it. `hidden` does
    // not apply there.
    bool own_hides = false;
};

// A small lamp without shadow. Its light fades to zero at reach_m, so it hardly leaks through
// walls.
struct Lamp {
    Vec3 position_ws = Vec3::Zero();
    Color color = {1.0F, 1.0F, 1.0F};  // multiplied by the intensity at 1 m
    double reach_m = 4.0;              // > 0
};

// The only light with shadows. In a room, a caster_reach_m of about 1 m makes it a ceiling lamp
// (objects farther towards the light cast no shadow). Outdoors, the scene's size makes it the sun.
struct KeyLight {
    Vec3 towards_ws = Vec3(0.35, 0.9, 0.25);  // not zero
    Color color = {0.50F, 0.47F, 0.43F};
    double caster_reach_m = 1.0;
    double shadow_radius_m =
        3.5;  // radius of the region in front of the camera where shadows are drawn
};

// Sides of an eye's picture at distance 1 along -Z. Right and up are positive. left < right, down <
// up.
struct EyeFrustum {
    double left = -1.0;
    double right = 1.0;
    double down = -1.0;
    double up = 1.0;
};

// The camera looks along its -Z; +Y is up in the picture.
struct Camera {
    Pose pose_ws;
    double vertical_fov_rad = 1.2;
    std::optional<EyeFrustum> frustum;  // instead of vertical_fov_rad
    double near_m = 0.03;
};

struct UiPicture;  // ui_picture.hpp

// Panels on a sheet in the world, hidden by geometry in front. The pose is at its centre; +Z points
// to the reader, +Y up.
struct Sheet {
    const UiPicture* ui = nullptr;  // must outlive the drawing
    std::array<int, 2> size_px = {1, 1};
    Pose pose_ws;
    double width_m = 0.6;
};

enum class Backdrop { plain, space };  // space: stars, and a planet in direction planet_ws

struct RenderFrame {
    Camera camera;
    std::vector<Instance> instances;
    std::vector<Ghost> ghosts;
    std::vector<Line> lines;
    float hidden_lines = 0.22F;  // [0, 1]; opacity of lines behind geometry
    std::optional<Sheet> sheet;
    std::vector<Lamp> lamps;  // the twelve with most influence around the camera are used
    KeyLight key;
    // Ambient light blends from ground_ambient to sky_ambient along this direction.
    Vec3 up_ws = Vec3::UnitY();
    Color sky_ambient = {0.16F, 0.175F, 0.20F};
    Color ground_ambient = {0.11F, 0.105F, 0.10F};
    float head_light = 0.06F;  // strength of a lamp at the camera that keeps dark places readable
    float exposure = 1.0F;
    float haze_per_m = 0.010F;  // fraction of haze per metre of distance
    Color haze = {0.20F, 0.23F, 0.27F};
    Backdrop backdrop = Backdrop::plain;
    Color background = {0.0F, 0.0F, 0.0F};      // Backdrop::plain; shown without tone mapping
    Vec3 planet_ws = Vec3(0.25, -0.85, -0.75);  // direction of the planet's centre
};

}  // namespace handhold
