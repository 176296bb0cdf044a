#pragma once

#include <span>
#include <string>

#include "game/render/frame_view.hpp"
#include "game/render/gpu_mesh.hpp"
#include "game/render/picture_passes.hpp"

namespace handhold {

// Draws a frame's ghosts over what is drawn already: the nearest of their surfaces at each pixel
// and no more, so that no fingers shimmer through a palm; behind what hides them too. Their depths
// lie in a texture of their own, and the scene's say how far behind it they are. Those with
// Ghost::own_hides are not drawn behind what is_own: an arm seen lengthwise is no wall before its
// hand. What the scene's depths are used for afterwards sees no ghosts. Costs nothing while there
// are none.
class GhostPass {
  public:
    // False, and the reason, where the card refuses.
    bool create(GlApi api, std::string& why_not);
    // Leaves the scene's target bound. Returns how many meshes it drew, in both passes.
    // Precondition: the ghosts' meshes lie in `meshes`, and the depth test is on.
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
    GlTexture depth_;       // made with the first ghost
    GlFramebuffer target_;  // the scene's colours over it
};

}  // namespace handhold
