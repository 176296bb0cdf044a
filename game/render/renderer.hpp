#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/geometry/mesh.hpp"
#include "game/mesh/image.hpp"
#include "game/mesh/render_frame.hpp"
#include "game/render/gl_context.hpp"

namespace handhold {

struct UiPicture;  // ui_picture.hpp

// Cost of the last picture.
struct RenderCounters {
    int draw_calls = 0;      // draw calls of meshes, in all passes
    int triangles = 0;       // triangles of instances, submitted in all passes; without ghosts
    int instances_seen = 0;  // inside the camera's frustum
    int instances_given = 0;
};

// plain: no shadows, ambient occlusion or glow; for software rasterisers. quick: one sample per
// pixel with edge smoothing; for films and many pictures. fine: four samples per pixel at four
// times the cost; for single pictures.
enum class PictureQuality { plain, quick, fine };

// Draws frames into memory. Needs no display and no window, only an EGL with surfaceless contexts
// (Mesa has them, with or without a graphics card). Uses OpenGL 3.3 core, or OpenGL ES 3.0 if
// nothing else is available. One thread at a time; several renderers may coexist.
class Renderer {
  public:
    // nullopt, with the reason in `why_not`, if the machine cannot draw. Precondition: both sizes
    // in [16, 8192].
    static std::optional<Renderer> create(int width_px, int height_px, std::string& why_not,
                                          PictureQuality quality = PictureQuality::quick);
    Renderer(Renderer&& other) noexcept;
    Renderer& operator=(Renderer&& other) noexcept;
    ~Renderer();

    // Copies the mesh to the graphics card, where it stays as long as the renderer. Edges below 35
    // degrees are shaded smooth for any winding; both sides of a triangle are lit. An empty mesh is
    // allowed and draws nothing.
    MeshId add_mesh(const Mesh& mesh);
    // Adds a mesh whose vertices come from move_mesh; until then it draws nothing.
    MeshId add_moving_mesh(std::span<const std::array<std::uint32_t, 3>> triangles,
                           const Color& color);
    // Sets vertices and normals, which stay until the next call. Precondition: the mesh was added
    // by add_moving_mesh, and its triangles use no vertex beyond `positions`.
    void move_mesh(MeshId mesh, std::span<const Vec3> positions, std::span<const Vec3> normals);
    // Draws the frame at the size given to create(). Skips instances and lines that are not finite.
    // Precondition: every instance's mesh came from this renderer. `ui`: panels drawn on top, may
    // be null.
    void draw(const RenderFrame& frame, Image& out, const UiPicture* ui = nullptr);
    // Like draw(), but into an OpenGL texture of the same size with eight sRGB bits per channel,
    // bottom row first. If `copy` is given, reads the texture back into it.
    void draw_into(std::uint32_t texture, const RenderFrame& frame, Image* copy = nullptr,
                   const UiPicture* ui = nullptr);

    // The OpenGL context, for a library that shares it (an XR runtime). Valid as long as the
    // renderer.
    const GlContext& context() const;
    const RenderCounters& counters() const;

  private:
    struct Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    void draw_picture(const RenderFrame& frame, const UiPicture* ui);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
