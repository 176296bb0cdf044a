#include "game/render/picture_passes.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "game/render/picture_shaders.hpp"

namespace handhold {
namespace {

constexpr int k_occlusion_part = 2;  // divisor of the picture's width and height
constexpr int k_glow_part = 4;
constexpr float k_occlusion_radius_m = 0.16F;
constexpr float k_glow_strength = 0.55F;

void bind_texture(int unit, GLuint texture) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, texture);
}

// Runs the current program over a whole target. The program's input picture is on texture unit 0.
void fill(GLuint target, int width_px, int height_px) {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(0, 0, width_px, height_px);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::array<float, 2> texel_of(int width_px, int height_px) {
    return {1.0F / static_cast<float>(width_px), 1.0F / static_cast<float>(height_px)};
}

}  // namespace

bool PicturePasses::create(GlApi api, const PictureSize& size, std::string& why_not) {
    size_ = size;
    const int scene_width = size.width_px * size.samples_across;
    const int scene_height = size.height_px * size.samples_across;
    color_ = make_texture(scene_width, scene_height, k_color_texture);
    depth_ = make_texture(scene_width, scene_height, k_depth_texture);
    scene_target_ = make_framebuffer(color_, depth_);
    bool is_complete = is_framebuffer_complete();
    const auto make_target = [&](GlTexture& texture, GlFramebuffer& target, int part) {
        texture = make_texture(size.width_px / part, size.height_px / part, k_color_texture);
        target = make_framebuffer(texture, 0);
        is_complete = is_complete && is_framebuffer_complete();
    };
    make_target(occlusion_, occlusion_target_, k_occlusion_part);
    make_target(occlusion_smooth_, smooth_target_, k_occlusion_part);
    make_target(glow_, glow_target_, k_glow_part);
    make_target(glow_spare_, glow_spare_target_, k_glow_part);
    make_target(composed_, composed_target_, 1);
    make_target(final_, final_target_, 1);
    if (!is_complete) {
        why_not = "the graphics driver does not support a target of this size";
        return false;
    }
    const auto compile = [&](GlProgram& program, const char* fragment) {
        program = make_program(api, shaders::k_screen_vertex, fragment, why_not);
        return program != 0U;
    };
    clear_effects();
    return ui_painter_.create(api, why_not) &&
           compile(occlusion_program_, shaders::k_occlusion_fragment) &&
           compile(smooth_program_, shaders::k_smooth_fragment) &&
           compile(glow_program_, shaders::k_glow_fragment) &&
           compile(blur_program_, shaders::k_blur_fragment) &&
           compile(composite_program_, shaders::k_composite_fragment) &&
           compile(edges_program_, shaders::k_edges_fragment);
}

// Clears the results of the effects, for pictures without effects: no occlusion and no glow.
void PicturePasses::clear_effects() {
    for (const auto& [target, brightness] :
         {std::pair{GLuint{smooth_target_}, 1.0F}, std::pair{GLuint{glow_target_}, 0.0F}}) {
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        glClearColor(brightness, brightness, brightness, brightness);
        glClear(GL_COLOR_BUFFER_BIT);
    }
}

void PicturePasses::begin() const {
    bind_scene();
    glViewport(0, 0, size_.width_px * size_.samples_across, size_.height_px * size_.samples_across);
}

void PicturePasses::bind_scene() const { glBindFramebuffer(GL_FRAMEBUFFER, scene_target_); }

void PicturePasses::shade_occlusion(const FrameView& view) {
    const int width = size_.width_px / k_occlusion_part;
    const int height = size_.height_px / k_occlusion_part;
    glUseProgram(occlusion_program_);
    bind_texture(0, depth_);
    set_uniform(occlusion_program_, "depth_map", 0);
    set_uniform(occlusion_program_, "depth_terms",
                std::array<float, 2>{static_cast<float>(view.depth_scale),
                                     static_cast<float>(view.depth_offset)});
    set_uniform(occlusion_program_, "half_extent",
                std::array<float, 2>{static_cast<float>(view.half_width),
                                     static_cast<float>(view.half_height)});
    set_uniform(
        occlusion_program_, "middle",
        std::array<float, 2>{static_cast<float>(view.middle_x), static_cast<float>(view.middle_y)});
    set_uniform(
        occlusion_program_, "texel",
        texel_of(size_.width_px * size_.samples_across, size_.height_px * size_.samples_across));
    set_uniform(occlusion_program_, "radius_m", k_occlusion_radius_m);
    fill(occlusion_target_, width, height);
    glUseProgram(smooth_program_);
    bind_texture(0, occlusion_);
    set_uniform(smooth_program_, "picture", 0);
    set_uniform(smooth_program_, "texel", texel_of(width, height));
    fill(smooth_target_, width, height);
}

void PicturePasses::blur_glow() {
    const int width = size_.width_px / k_glow_part;
    const int height = size_.height_px / k_glow_part;
    glUseProgram(glow_program_);
    bind_texture(0, color_);
    set_uniform(glow_program_, "picture", 0);
    set_uniform(glow_program_, "texel", texel_of(size_.width_px, size_.height_px));
    fill(glow_target_, width, height);
    glUseProgram(blur_program_);
    set_uniform(blur_program_, "picture", 0);
    const std::array<float, 2> texel = texel_of(width, height);
    bind_texture(0, glow_);
    set_uniform(blur_program_, "step_uv", std::array<float, 2>{texel[0], 0.0F});
    fill(glow_spare_target_, width, height);
    bind_texture(0, glow_spare_);
    set_uniform(blur_program_, "step_uv", std::array<float, 2>{0.0F, texel[1]});
    fill(glow_target_, width, height);
}

void PicturePasses::compose() {
    glUseProgram(composite_program_);
    bind_texture(0, color_);
    bind_texture(1, occlusion_smooth_);
    bind_texture(2, glow_);
    set_uniform(composite_program_, "picture", 0);
    set_uniform(composite_program_, "occlusion", 1);
    set_uniform(composite_program_, "glow", 2);
    set_uniform(composite_program_, "glow_strength", k_glow_strength);
    fill(composed_target_, size_.width_px, size_.height_px);
    if (size_.samples_across == 1) {
        glUseProgram(edges_program_);
        bind_texture(0, composed_);
        set_uniform(edges_program_, "picture", 0);
        set_uniform(edges_program_, "texel", texel_of(size_.width_px, size_.height_px));
        fill(final_target_, size_.width_px, size_.height_px);
    }
}

void PicturePasses::finish(const FrameView& view, const Sheet* sheet, const UiPicture* ui) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    if (size_.effects) {
        shade_occlusion(view);
        blur_glow();
    }
    compose();
    if (sheet != nullptr && sheet->ui != nullptr && is_valid(sheet->pose_ws)) {
        ui_painter_.draw_sheet(*sheet, view, depth_, {size_.width_px, size_.height_px},
                               size_.samples_across);
    }
    if (ui != nullptr) {
        ui_painter_.draw(*ui, {size_.width_px, size_.height_px});
    }
    copied_ = false;
}

void PicturePasses::copy_into(GLuint texture) {
    const GLuint finished = size_.samples_across == 1 ? final_target_ : composed_target_;
    copy_target_ = make_framebuffer(texture, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, finished);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, copy_target_);
    glBlitFramebuffer(0, 0, size_.width_px, size_.height_px, 0, size_.height_px, size_.width_px, 0,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, copy_target_);
    copied_ = true;
}

// The finished picture is upside down in OpenGL, so its first row is the top. A picture that was
// copied into a texture is upright there and is flipped here.
void PicturePasses::read(Image& out) const {
    out.width_px = size_.width_px;
    out.height_px = size_.height_px;
    const auto pixels =
        static_cast<std::size_t>(size_.width_px) * static_cast<std::size_t>(size_.height_px);
    out.rgba.resize(4 * pixels);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size_.width_px, size_.height_px, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
    const auto row = 4 * static_cast<std::ptrdiff_t>(size_.width_px);
    for (int y = 0; copied_ && y < size_.height_px / 2; ++y) {
        const auto top = out.rgba.begin() + y * row;
        std::swap_ranges(top, top + row, out.rgba.end() - (y + 1) * row);
    }
    // Until here, alpha held the brightness for the edge filter.
    for (std::size_t i = 0; i < pixels; ++i) {
        out.rgba[4 * i + 3] = 255;
    }
}

}  // namespace handhold
