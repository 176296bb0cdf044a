#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/geometry/mesh.hpp"
#include "game/render/gl_context.hpp"
#include "game/render/image.hpp"
#include "game/render/render_frame.hpp"

namespace handhold {

struct UiPicture;  // ui_picture.hpp

// What the last picture cost.
struct RenderCounters {
    int draw_calls = 0;      // of meshes, in all passes
    int triangles = 0;       // sent, in all passes
    int instances_seen = 0;  // inside the camera's frustum
    int instances_given = 0;
};

// plain: no shadows, no darkened corners, no glow; for processors that stand in for a graphics
// card. quick: one sample a pixel, edges smoothed afterwards; for films and crowds of pictures.
// fine: four samples a pixel, four times the work; for pictures that are looked at.
enum class PictureQuality { plain, quick, fine };

// Draws frames into memory; needs no display and no window, only an EGL that knows surfaceless
// contexts (Mesa's does, with or without a graphics card). OpenGL 3.3 core, or OpenGL ES 3.0 where
// that is all there is. One thread at a time; several renderers may live side by side.
class Renderer {
  public:
    // Nothing, and the reason, where the machine cannot. Precondition: both sizes in [16, 8192].
    static std::optional<Renderer> create(int width_px, int height_px, std::string& why_not,
                                          PictureQuality quality = PictureQuality::quick);
    Renderer(Renderer&& other) noexcept;
    Renderer& operator=(Renderer&& other) noexcept;
    ~Renderer();

    // Keeps a copy on the graphics side until the renderer ends. Edges below 35 degrees are shaded
    // smooth, whatever the winding; both sides of a triangle are lit. An empty mesh is allowed and
    // draws nothing.
    MeshId add_mesh(const Mesh& mesh);
    // A mesh whose vertices come with move_mesh: before that it draws nothing.
    MeshId add_moving_mesh(std::span<const std::array<std::uint32_t, 3>> triangles,
                           const Color& color);
    // Gives it its vertices and their normals, as they are until the next call. Precondition: the
    // mesh is a moving one and its triangles name no vertex beyond.
    void move_mesh(MeshId mesh, std::span<const Vec3> positions, std::span<const Vec3> normals);
    // The frame as a picture of the size given to create(). Instances and lines that are not finite
    // are left out. Precondition: every instance's mesh came from this renderer.
    // Panels are drawn over it where there are.
    void draw(const RenderFrame& frame, Image& out, const UiPicture* ui = nullptr);
    // The same into a texture of OpenGL's, of the same size and of eight bits a channel in sRGB,
    // rows from the bottom; and, where it is given, into `copy` out of that texture.
    void draw_into(std::uint32_t texture, const RenderFrame& frame, Image* copy = nullptr,
                   const UiPicture* ui = nullptr);

    // For a library that shares it: a headset's runtime. Lives as long as the renderer.
    const GlContext& context() const;
    const RenderCounters& counters() const;

  private:
    struct Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    void draw_picture(const RenderFrame& frame, const UiPicture* ui);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
