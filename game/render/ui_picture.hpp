#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "game/mesh/image.hpp"

namespace handhold {

// Panels over the finished picture, as triangles in pixels; (0, 0) is the upper left corner.
struct UiVertex {
    std::array<float, 2> place_px;
    std::array<float, 2> glyph_uv;
    std::array<std::uint8_t, 4> rgba;  // sRGB, not premultiplied
};
struct UiCommand {
    std::array<int, 4> clip_px;  // left, top, right, bottom
    std::uint32_t first = 0;     // first index, in UiPicture::indices
    std::uint32_t count = 0;
};
struct UiPicture {
    std::vector<UiVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<UiCommand> commands;
    Image glyphs;                       // texture of the letters: white, their shapes in alpha
    std::uint32_t glyphs_revision = 0;  // changes whenever `glyphs` changes
};

}  // namespace handhold
