#include "game/render/ui_painter.hpp"

#include <algorithm>
#include <cstddef>

#include "game/render/shaders.hpp"

namespace handhold {
namespace {

const void* offset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr): OpenGL's way
}

}  // namespace

bool UiPainter::create(GlApi api, std::string& why_not) {
    program_ = make_program(api, shaders::k_ui_vertex, shaders::k_ui_fragment, why_not);
    sheet_program_ = make_program(api, shaders::k_sheet_vertex, shaders::k_sheet_fragment, why_not);
    layout_ = make_vertex_array();
    vertices_ = make_buffer();
    indices_ = make_buffer();
    glBindVertexArray(layout_);
    glBindBuffer(GL_ARRAY_BUFFER, vertices_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    const auto attribute = [](GLuint at, GLint count, GLenum type, GLboolean scaled,
                              std::size_t from) {
        glEnableVertexAttribArray(at);
        glVertexAttribPointer(at, count, type, scaled, sizeof(UiVertex), offset(from));
    };
    attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(UiVertex, place_px));
    attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(UiVertex, glyph_uv));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(UiVertex, rgba));
    return program_ != 0U && sheet_program_ != 0U;
}

void UiPainter::upload(const UiPicture& ui) {
    glBindVertexArray(layout_);
    glBindBuffer(GL_ARRAY_BUFFER, vertices_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(ui.vertices.size() * sizeof(UiVertex)),
                 ui.vertices.data(), GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(ui.indices.size() * sizeof(std::uint32_t)),
                 ui.indices.data(), GL_STREAM_DRAW);
    glActiveTexture(GL_TEXTURE0);
    if (glyphs_ == 0U || glyphs_revision_ != ui.glyphs_revision) {
        glyphs_ = make_texture(ui.glyphs.width_px, ui.glyphs.height_px, k_color_texture);
        glBindTexture(GL_TEXTURE_2D, glyphs_);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, ui.glyphs.width_px, ui.glyphs.height_px, GL_RGBA,
                        GL_UNSIGNED_BYTE, ui.glyphs.rgba.data());
        glyphs_revision_ = ui.glyphs_revision;
    }
    glBindTexture(GL_TEXTURE_2D, glyphs_);
}

void UiPainter::draw(const UiPicture& ui, std::array<int, 2> size_px) {
    if (ui.commands.empty() || ui.glyphs.width_px == 0) {
        return;
    }
    upload(ui);
    glUseProgram(program_);
    set_uniform(program_, "glyphs", 0);
    set_uniform(
        program_, "size_px",
        std::array<float, 2>{static_cast<float>(size_px[0]), static_cast<float>(size_px[1])});
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_SCISSOR_TEST);
    for (const UiCommand& command : ui.commands) {
        const int left = std::max(command.clip_px[0], 0);
        const int top = std::max(command.clip_px[1], 0);
        const int width = std::min(command.clip_px[2], size_px[0]) - left;
        const int height = std::min(command.clip_px[3], size_px[1]) - top;
        if (width > 0 && height > 0) {
            glScissor(left, top, width, height);
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.count), GL_UNSIGNED_INT,
                           offset(command.first * sizeof(std::uint32_t)));
        }
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
}

void UiPainter::draw_sheet(const Sheet& sheet, const FrameView& view, GLuint scene_depth,
                           std::array<int, 2> size_px, int samples_across) {
    const UiPicture& ui = *sheet.ui;
    if (ui.commands.empty() || ui.glyphs.width_px == 0) {
        return;
    }
    upload(ui);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, scene_depth);
    const auto floats = [](double a, double b) {
        return std::array<float, 2>{static_cast<float>(a), static_cast<float>(b)};
    };
    glUseProgram(sheet_program_);
    set_uniform(sheet_program_, "glyphs", 0);
    set_uniform(sheet_program_, "scene_depth", 1);
    set_uniform(sheet_program_, "cs_to_clip", view.cs_to_clip);
    set_uniform(sheet_program_, "sheet_to_cs",
                make_model_matrix(sheet.pose_ws.rotation, sheet.pose_ws.position - view.eye_ws));
    set_uniform(sheet_program_, "sheet_px", floats(sheet.size_px[0], sheet.size_px[1]));
    set_uniform(sheet_program_, "m_per_px", static_cast<float>(sheet.width_m / sheet.size_px[0]));
    set_uniform(sheet_program_, "target_rows", static_cast<float>(size_px[1]));
    set_uniform(sheet_program_, "samples_across", samples_across);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const UiCommand& command : ui.commands) {
        const auto& clip = command.clip_px;
        set_uniform(sheet_program_, "clip_px",
                    std::array<float, 4>{static_cast<float>(clip[0]), static_cast<float>(clip[1]),
                                         static_cast<float>(clip[2]), static_cast<float>(clip[3])});
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.count), GL_UNSIGNED_INT,
                       offset(command.first * sizeof(std::uint32_t)));
    }
    glDisable(GL_BLEND);
    glActiveTexture(GL_TEXTURE0);
}

}  // namespace handhold
