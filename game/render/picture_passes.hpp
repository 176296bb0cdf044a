#pragma once

#include <array>
#include <string>

#include "game/mesh/image.hpp"
#include "game/render/frame_view.hpp"
#include "game/render/gl_objects.hpp"
#include "game/render/ui_painter.hpp"

namespace handhold {

// Size of the finished picture, and samples per pixel along each axis (1 or 2).
struct PictureSize {
    int width_px = 0;
    int height_px = 0;
    int samples_across = 1;
    bool effects = true;  // ambient occlusion and glow
};

// The passes after the triangles of a picture: ambient occlusion, glow, resolving the samples of a
// pixel (or smoothing edges if there is one sample), panels, and read-back. Uses supersampling
// instead of the card's multisampling. The software rasteriser also shades hidden fragments of a
// multisampled target; for it, 2 x 2 samples cost half as much as four multisamples.
class PicturePasses {
  public:
    // False, with the reason in `why_not`, if the graphics driver cannot create the resources.
    bool create(GlApi api, const PictureSize& size, std::string& why_not);
    // Binds and clears the target that the scene is drawn into.
    void begin() const;
    // Binds the scene's target again, after another target was bound.
    void bind_scene() const;
    // Textures and size of the scene target.
    GLuint color() const { return color_; }
    GLuint depth() const { return depth_; }
    std::array<int, 2> scene_size_px() const {
        return {size_.width_px * size_.samples_across, size_.height_px * size_.samples_across};
    }
    // Produces the finished picture from the scene target. `sheet`, `ui`: panels in the world and
    // on top; may be null. Precondition: some vertex array is bound.
    void finish(const FrameView& view, const Sheet* sheet, const UiPicture* ui);
    // Copies the finished bytes unchanged into a texture of the same size, bottom row first. If the
    // texture is sRGB, the bytes are not encoded a second time.
    void copy_into(GLuint texture);
    // Reads the finished picture, or the texture that it was last copied into.
    void read(Image& out) const;

  private:
    void shade_occlusion(const FrameView& view);
    void blur_glow();
    void compose();
    void clear_effects();

    PictureSize size_;
    GlTexture color_, depth_, occlusion_, occlusion_smooth_, glow_, glow_spare_, composed_, final_;
    GlFramebuffer scene_target_, occlusion_target_, smooth_target_, glow_target_,
        glow_spare_target_, composed_target_, final_target_;
    GlFramebuffer copy_target_;
    bool copied_ = false;
    GlProgram occlusion_program_, smooth_program_, glow_program_, blur_program_, composite_program_,
        edges_program_;
    UiPainter ui_painter_;
};

}  // namespace handhold
