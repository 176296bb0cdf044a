#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "game/render/frame_view.hpp"
#include "game/render/gl_objects.hpp"
#include "game/render/ui_picture.hpp"

namespace handhold {

// Draws panels over the bound target, which is upside down: its lowest row is the picture's top.
class UiPainter {
  public:
    // False, with the compiler's message in `why_not`, if the programs do not compile.
    bool create(GlApi api, std::string& why_not);
    void draw(const UiPicture& ui, std::array<int, 2> size_px);
    // Draws panels on a sheet in the world where the scene's depths (`samples_across` samples per
    // pixel along each axis) do not hide it. Precondition: the sheet has panels and a valid pose.
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
