#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "game/render/frame_view.hpp"
#include "game/render/gl_objects.hpp"
#include "game/render/ui_picture.hpp"

namespace handhold {

// Draws panels over whatever target is bound, whose rows go from the top as our pictures' do.
class UiPainter {
  public:
    // False, and the compiler's words, where the card refuses.
    bool create(GlApi api, std::string& why_not);
    void draw(const UiPicture& ui, std::array<int, 2> size_px);
    // Panels on a sheet in the world, where the scene's depths (as many samples across a pixel) do
    // not hide it. Precondition: it has panels, and its pose is valid.
    void draw_sheet(const Sheet& sheet, const FrameView& view, GLuint scene_depth,
                    std::array<int, 2> size_px, int samples_across);

  private:
    void upload(const UiPicture& ui);

    GlProgram program_, sheet_program_;
    GlVertexArray layout_;
    GlBuffer vertices_, indices_;
    GlTexture glyphs_;
    std::uint32_t glyphs_revision_ = 0;
};

}  // namespace handhold
