#include "game/render/ghost_pass.hpp"

#include "engine/core/check.hpp"
#include "game/render/ghost_shader.hpp"
#include "game/render/shaders.hpp"

namespace handhold {
namespace {

bool is_drawn(const Ghost& ghost) {
    return (ghost.seen > 0.0F || ghost.hidden > 0.0F) && is_valid(ghost.pose_ws);
}

void draw_mesh_at(GLuint program, const Pose& pose_ws, const GpuMesh& mesh, const FrameView& view) {
    const Vec3 center_cs = transform_point(pose_ws, mesh.center) - view.eye_ws;
    set_uniform(program, "model_to_cs", make_model_matrix(pose_ws.rotation, center_cs));
    glBindVertexArray(mesh.layout);
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
}

bool is_in_picture(const Pose& pose_ws, const GpuMesh& mesh, const FrameView& view) {
    return mesh.index_count > 0 &&
           sees_sphere(view, transform_point(pose_ws, mesh.center) - view.eye_ws, mesh.radius_m);
}

void bind_scene_depth(GLuint program, const PicturePasses& passes) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, passes.depth());
    set_uniform(program, "scene_depth", 0);
}

}  // namespace

bool GhostPass::create(GlApi api, std::string& why_not) {
    depth_program_ = make_program(api, shaders::k_depth_vertex, shaders::k_depth_fragment, why_not);
    own_program_ =
        make_program(api, shaders::k_depth_vertex, shaders::k_own_depth_fragment, why_not);
    ghost_program_ = make_program(api, shaders::k_mesh_vertex, shaders::k_ghost_fragment, why_not);
    return depth_program_ != 0U && own_program_ != 0U && ghost_program_ != 0U;
}

int GhostPass::draw(const RenderFrame& frame, const FrameView& view,
                    std::span<const GpuMesh> meshes, const PicturePasses& passes) {
    std::array<bool, 2> any{};  // indexed by Ghost::own_hides
    for (const Ghost& ghost : frame.ghosts) {
        HH_CHECK(static_cast<std::size_t>(ghost.mesh) < meshes.size(), "no such mesh",
                 static_cast<std::size_t>(ghost.mesh));
        any[ghost.own_hides ? 1 : 0] = any[ghost.own_hides ? 1 : 0] || is_drawn(ghost);
    }
    if (!any[0] && !any[1]) {
        return 0;
    }
    if (depth_ == 0U) {
        const std::array<int, 2> size_px = passes.scene_size_px();
        depth_ = make_texture(size_px[0], size_px[1], k_depth_texture);
        target_ = make_framebuffer(passes.color(), depth_);
    }
    const Picture picture{frame, view, meshes, passes};
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    const int drawn =
        (any[1] ? draw_alike(picture, true) : 0) + (any[0] ? draw_alike(picture, false) : 0);
    passes.bind_scene();
    return drawn;
}

// Draws the ghosts whose Ghost::own_hides equals `own_hides`.
int GhostPass::draw_alike(const Picture& picture, bool own_hides) const {
    const FrameView& view = picture.view;
    int drawn = 0;
    const auto for_each = [&](const auto& visit) {
        for (const Ghost& ghost : picture.frame.ghosts) {
            const GpuMesh& mesh = picture.meshes[static_cast<std::size_t>(ghost.mesh)];
            if (ghost.own_hides == own_hides && is_drawn(ghost) &&
                is_in_picture(ghost.pose_ws, mesh, view)) {
                visit(ghost, mesh);
                ++drawn;
            }
        }
    };
    glClear(GL_DEPTH_BUFFER_BIT);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    if (own_hides) {
        drawn += draw_own_depths(picture);
    }
    glUseProgram(depth_program_);
    set_uniform(depth_program_, "cs_to_clip", view.cs_to_clip);
    for_each([&](const Ghost& ghost, const GpuMesh& mesh) {
        draw_mesh_at(depth_program_, ghost.pose_ws, mesh, view);
    });
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthMask(GL_FALSE);
    glUseProgram(ghost_program_);
    bind_scene_depth(ghost_program_, picture.passes);
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
        draw_mesh_at(ghost_program_, ghost.pose_ws, mesh, view);
    });
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    return drawn;
}

// Writes the depths of the player's own instances, but only of their visible pixels. An arm inside
// a wall must not hide the ghost hand there.
int GhostPass::draw_own_depths(const Picture& picture) const {
    int drawn = 0;
    glUseProgram(own_program_);
    bind_scene_depth(own_program_, picture.passes);
    set_uniform(own_program_, "cs_to_clip", picture.view.cs_to_clip);
    for (const Instance& own : picture.frame.instances) {
        const GpuMesh& mesh = picture.meshes[static_cast<std::size_t>(own.mesh)];
        if (own.is_own && is_valid(own.pose_ws) && is_in_picture(own.pose_ws, mesh, picture.view)) {
            draw_mesh_at(own_program_, own.pose_ws, mesh, picture.view);
            ++drawn;
        }
    }
    return drawn;
}

}  // namespace handhold
