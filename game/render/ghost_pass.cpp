#include "game/render/ghost_pass.hpp"

#include "engine/core/check.hpp"
#include "game/render/ghost_shader.hpp"
#include "game/render/shaders.hpp"

namespace handhold {
namespace {

bool has_strength(const Ghost& ghost) { return ghost.seen > 0.0F || ghost.hidden > 0.0F; }

void draw_ghost(GLuint program, const Ghost& ghost, const GpuMesh& mesh, const FrameView& view) {
    const Vec3 center_cs = transform_point(ghost.pose_ws, mesh.center) - view.eye_ws;
    set_uniform(program, "model_to_cs", make_model_matrix(ghost.pose_ws.rotation, center_cs));
    glBindVertexArray(mesh.layout);
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
}

}  // namespace

bool GhostPass::create(GlApi api, std::string& why_not) {
    depth_program_ = make_program(api, shaders::k_depth_vertex, shaders::k_depth_fragment, why_not);
    ghost_program_ = make_program(api, shaders::k_mesh_vertex, shaders::k_ghost_fragment, why_not);
    return depth_program_ != 0U && ghost_program_ != 0U;
}

int GhostPass::draw(const RenderFrame& frame, const FrameView& view,
                    std::span<const GpuMesh> meshes, const PicturePasses& passes) {
    for (const Ghost& ghost : frame.ghosts) {
        HH_CHECK(static_cast<std::size_t>(ghost.mesh) < meshes.size(), "no such mesh",
                 static_cast<std::size_t>(ghost.mesh));
    }
    int drawn = 0;
    const auto for_each = [&](const auto& visit) {
        for (const Ghost& ghost : frame.ghosts) {
            const GpuMesh& mesh = meshes[static_cast<std::size_t>(ghost.mesh)];
            if (mesh.index_count > 0 && has_strength(ghost) && is_valid(ghost.pose_ws) &&
                sees_sphere(view, transform_point(ghost.pose_ws, mesh.center) - view.eye_ws,
                            mesh.radius_m)) {
                visit(ghost, mesh);
                ++drawn;
            }
        }
    };
    if (frame.ghosts.empty()) {
        return 0;
    }
    const std::array<int, 2> size_px = passes.scene_size_px();
    if (depth_ == 0U) {
        depth_ = make_texture(size_px[0], size_px[1], k_depth_texture);
        target_ = make_framebuffer(passes.color(), depth_);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glClear(GL_DEPTH_BUFFER_BIT);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glUseProgram(depth_program_);
    set_uniform(depth_program_, "cs_to_clip", view.cs_to_clip);
    for_each([&](const Ghost& ghost, const GpuMesh& mesh) {
        draw_ghost(depth_program_, ghost, mesh, view);
    });
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthMask(GL_FALSE);
    glUseProgram(ghost_program_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, passes.depth());
    set_uniform(ghost_program_, "scene_depth", 0);
    set_uniform(ghost_program_, "depth_terms",
                std::array<float, 2>{static_cast<float>(view.depth_scale),
                                     static_cast<float>(view.depth_offset)});
    set_uniform(ghost_program_, "cs_to_clip", view.cs_to_clip);
    for_each([&](const Ghost& ghost, const GpuMesh& mesh) {
        set_uniform(ghost_program_, "tint", ghost.color);
        set_uniform(ghost_program_, "seen", ghost.seen);
        set_uniform(ghost_program_, "hidden", ghost.hidden);
        set_uniform(ghost_program_, "hidden_from_m", static_cast<float>(ghost.hidden_from_m));
        set_uniform(ghost_program_, "hidden_full_m", static_cast<float>(ghost.hidden_full_m));
        draw_ghost(ghost_program_, ghost, mesh, view);
    });
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    passes.bind_scene();
    return drawn;
}

}  // namespace handhold
