#pragma once

#include <array>
#include <vector>

#include "game/mesh/render_frame.hpp"

// Projection arithmetic without OpenGL. Suffix _cs: relative to the camera's position, in the
// world's axes.
namespace handhold {

using Matrix4 = std::array<float, 16>;  // column-major

struct FrameView {
    Vec3 eye_ws = Vec3::Zero();
    Quat from_view = Quat::Identity();  // rotation of the camera
    double half_width = 1.0;            // half the picture's width at distance 1
    double half_height = 1.0;
    // Offset of the picture's centre at distance 1; not 0 for a headset's eye.
    double middle_x = 0.0;
    double middle_y = 0.0;
    double near_m = 0.03;
    double depth_scale = 0.0;   // element P22 of the projection matrix
    double depth_offset = 0.0;  // element P32 of the projection matrix
    Matrix4 cs_to_clip{};
};
FrameView make_frame_view(const Camera& camera, int width_px, int height_px);

// Projects a point to clip space (x, y, z, w); w is the distance along the view direction.
std::array<double, 4> to_clip(const FrameView& view, const Vec3& point_cs);
// False only if the sphere is entirely outside the picture.
bool sees_sphere(const FrameView& view, const Vec3& center_cs, double radius_m);

// A parallel projection along the key light, over the region in front of the camera.
struct ShadowView {
    Mat3 axes_ws = Mat3::Identity();  // columns: right, up, towards the light
    Vec3 center_cs = Vec3::Zero();
    double radius_m = 1.0;
    double reach_m = 1.0;
    double texel_m = 0.01;
    Matrix4 cs_to_clip{};     // z = -1 at the farthest caster
    Matrix4 cs_to_texture{};  // cs_to_clip, mapped to [0, 1]
};
// The region moves by whole texels, so shadows do not crawl when the camera moves.
ShadowView make_shadow_view(const KeyLight& key, const FrameView& view, int size_px);
bool casts_shadow(const ShadowView& shadow, const Vec3& center_cs, double radius_m);

// Matrix from model space to camera-relative space. `origin_cs`: the model's origin, relative to
// the camera.
Matrix4 make_model_matrix(const Quat& rotation, const Vec3& origin_cs);

// The `limit` lamps that contribute most light around the camera, in the order of
// RenderFrame::lamps.
std::vector<Lamp> choose_lamps(const RenderFrame& frame, std::size_t limit);

struct LineVertex {
    std::array<float, 4> position;  // clip space
    std::array<float, 3> color;
};
// Six vertices per line: a quad of the line's width, clipped at the near plane. Skips lines behind
// the camera and lines that are not finite.
void build_line_vertices(const RenderFrame& frame, const FrameView& view,
                         std::array<int, 2> size_px, std::vector<LineVertex>& out);

}  // namespace handhold
