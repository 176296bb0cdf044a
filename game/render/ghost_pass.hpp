#pragma once

#include <span>
#include <string>

#include "game/render/frame_view.hpp"
#include "game/render/gpu_mesh.hpp"
#include "game/render/picture_passes.hpp"

namespace handhold {

// Draws a frame's ghosts over the finished scene. Per pixel only the nearest ghost surface is
// drawn, so fingers do not show through a palm. Ghosts also show through geometry: their depths go
// to a separate texture and are compared with the scene's. Ghosts with Ghost::own_hides do not show
// through instances with is_own, because a hand behind its own arm is not behind a wall. Later
// passes that read the scene's depths see no ghosts. Costs nothing without ghosts.
class GhostPass {
  public:
    // False, with the reason in `why_not`, if the graphics driver cannot create the resources.
    bool create(GlApi api, std::string& why_not);
    // Draws all ghosts and leaves the scene's target bound. Returns the number of meshes drawn, in
    // both passes. Precondition: the ghosts' meshes are in `meshes`, and the depth test is on.
    int draw(const RenderFrame& frame, const FrameView& view, std::span<const GpuMesh> meshes,
             const PicturePasses& passes);

  private:
    struct Picture {
        const RenderFrame& frame;
        const FrameView& view;
        std::span<const GpuMesh> meshes;
        const PicturePasses& passes;
    };
    int draw_alike(const Picture& picture, bool own_hides) const;
    int draw_own_depths(const Picture& picture) const;

    GlProgram depth_program_, own_program_, ghost_program_;
    GlTexture depth_;       // created with the first ghost
    GlFramebuffer target_;  // scene's colours with depth_
};

}  // namespace handhold
