#pragma once

#include <array>
#include <string>

#include "game/render/frame_view.hpp"
#include "game/render/gl_objects.hpp"
#include "game/render/image.hpp"
#include "game/render/ui_painter.hpp"

namespace handhold {

// The size of the finished picture, and how many samples it takes each way of a pixel (1 or 2).
struct PictureSize {
    int width_px = 0;
    int height_px = 0;
    int samples_across = 1;
    bool effects = true;  // darkened corners and glow
};

// Everything that happens to a picture once its triangles are drawn: corners darken (ambient
// occlusion), lamps glow, the samples of a pixel become one or, where there is one only, edges are
// smoothed, panels are drawn on top, and the bytes come back. Supersampling and not the card's
// multisampling: the software rasteriser shades hidden fragments too once a target is multisampled,
// and 2 x 2 samples then cost half of what four multisamples do.
class PicturePasses {
  public:
    // False, and the reason, where the card refuses.
    bool create(GlApi api, const PictureSize& size, std::string& why_not);
    // Binds the target that the scene is drawn into.
    void begin() const;
    // The same again, after another target.
    void bind_scene() const;
    // What it is made of, and its size.
    GLuint color() const { return color_; }
    GLuint depth() const { return depth_; }
    std::array<int, 2> scene_size_px() const {
        return {size_.width_px * size_.samples_across, size_.height_px * size_.samples_across};
    }
    // Makes what begin()'s target holds the finished picture, with panels where there are, in the
    // world and over all. Needs any vertex array bound.
    void finish(const FrameView& view, const Sheet* sheet, const UiPicture* ui);
    // The finished picture's bytes as they are, into a texture of the same size, rows from the
    // bottom: a texture in sRGB is not encoded again.
    void copy_into(GLuint texture);
    // The finished picture, or the texture that it was copied into since.
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
