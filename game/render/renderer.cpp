#include "game/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "game/render/frame_view.hpp"
#include "game/render/ghost_pass.hpp"
#include "game/render/gl_objects.hpp"
#include "game/render/gpu_mesh.hpp"
#include "game/render/picture_passes.hpp"
#include "game/render/picture_shaders.hpp"
#include "game/render/shaders.hpp"

namespace handhold {
namespace {

constexpr int k_shadow_size_px = 1024;
constexpr std::size_t k_max_lamps = 12;  // same number as in the mesh shader
constexpr int k_shadow_unit = 3;         // texture unit; the picture passes use 0 to 2

// An instance with triangles, and its position relative to the camera.
struct Visible {
    const Instance* instance = nullptr;
    const GpuMesh* mesh = nullptr;
    Vec3 center_cs = Vec3::Zero();
    double distance_m = 0.0;
};

float to_srgb(float x) {
    return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

}  // namespace

struct Renderer::Impl {
    // Declared first, so that it outlives every OpenGL name below.
    std::unique_ptr<GlContext> context;
    int width_px = 0;
    int height_px = 0;
    bool casts_shadows = true;
    std::vector<GpuMesh> meshes;
    GlProgram mesh_program, depth_program, line_program, backdrop_program;
    GlTexture shadow_map;
    GlFramebuffer shadow_target;
    GlVertexArray line_layout, empty_layout;
    GlBuffer line_buffer;
    PicturePasses passes;
    GhostPass ghosts;
    RenderCounters counters;
    std::vector<LineVertex> line_vertices;  // reused memory
    std::vector<Visible> visible;
    std::vector<float> moving_vertices;

    ~Impl() {
        if (context != nullptr) {
            context->make_current();
        }
    }
    bool create_programs(std::string& why_not);
    void create_shadow_map();
    void create_line_layout();
    void collect(const RenderFrame& frame, const FrameView& view);
    void draw_mesh(GLuint program, const Visible& item);
    void draw_shadows(const ShadowView& shadow);
    void set_lights(const RenderFrame& frame, const FrameView& view,
                    const ShadowView& shadow) const;
    void draw_surface(const Visible& item);
    void draw_opaque(const FrameView& view);
    void draw_glass(const FrameView& view);
    void draw_backdrop(const RenderFrame& frame, const FrameView& view) const;
    void draw_lines(const RenderFrame& frame, const FrameView& view);
};

bool Renderer::Impl::create_programs(std::string& why_not) {
    const GlApi api = context->api();
    mesh_program = make_program(api, shaders::k_mesh_vertex, shaders::k_mesh_fragment, why_not);
    depth_program = make_program(api, shaders::k_depth_vertex, shaders::k_depth_fragment, why_not);
    line_program = make_program(api, shaders::k_line_vertex, shaders::k_line_fragment, why_not);
    backdrop_program =
        make_program(api, shaders::k_screen_vertex, shaders::k_backdrop_fragment, why_not);
    return mesh_program != 0U && depth_program != 0U && line_program != 0U &&
           backdrop_program != 0U;
}

void Renderer::Impl::create_shadow_map() {
    shadow_map =
        make_texture(k_shadow_size_px, k_shadow_size_px,
                     {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_LINEAR});
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    shadow_target = make_framebuffer(0, shadow_map);
}

void Renderer::Impl::create_line_layout() {
    line_layout = make_vertex_array();
    line_buffer = make_buffer();
    empty_layout = make_vertex_array();
    glBindVertexArray(line_layout);
    glBindBuffer(GL_ARRAY_BUFFER, line_buffer);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(LineVertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex),
                          // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL's way of an offset
                          reinterpret_cast<const void*>(offsetof(LineVertex, color)));
}

// Collects finite instances, nearest first, so that near surfaces hide far ones before shading.
void Renderer::Impl::collect(const RenderFrame& frame, const FrameView& view) {
    visible.clear();
    for (const Instance& instance : frame.instances) {
        const auto index = static_cast<std::size_t>(instance.mesh);
        HH_CHECK(index < meshes.size(), "no such mesh", index);
        const GpuMesh& mesh = meshes[index];
        if (mesh.index_count == 0 || !is_valid(instance.pose_ws)) {
            continue;
        }
        const Vec3 center_cs = transform_point(instance.pose_ws, mesh.center) - view.eye_ws;
        visible.push_back({&instance, &mesh, center_cs, center_cs.norm() - mesh.radius_m});
    }
    std::stable_sort(visible.begin(), visible.end(), [](const Visible& a, const Visible& b) {
        return a.distance_m < b.distance_m;
    });
    counters.instances_given = static_cast<int>(frame.instances.size());
}

void Renderer::Impl::draw_mesh(GLuint program, const Visible& item) {
    set_uniform(program, "model_to_cs",
                make_model_matrix(item.instance->pose_ws.rotation, item.center_cs));
    glBindVertexArray(item.mesh->layout);
    glDrawElements(GL_TRIANGLES, item.mesh->index_count, GL_UNSIGNED_INT, nullptr);
    ++counters.draw_calls;
    counters.triangles += item.mesh->index_count / 3;
}

void Renderer::Impl::draw_shadows(const ShadowView& shadow) {
    glBindFramebuffer(GL_FRAMEBUFFER, shadow_target);
    glViewport(0, 0, k_shadow_size_px, k_shadow_size_px);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5F, 2.0F);
    glUseProgram(depth_program);
    set_uniform(depth_program, "cs_to_clip", shadow.cs_to_clip);
    for (const Visible& item : visible) {
        const Look& look = item.instance->look;
        if (casts_shadows && look.opacity >= 1.0F &&
            casts_shadow(shadow, item.center_cs, item.mesh->radius_m)) {
            draw_mesh(depth_program, item);
        }
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Impl::set_lights(const RenderFrame& frame, const FrameView& view,
                                const ShadowView& shadow) const {
    const GLuint program = mesh_program;
    glUseProgram(program);
    set_uniform(program, "cs_to_clip", view.cs_to_clip);
    set_uniform(program, "up", to_floats(frame.up_ws.normalized()));
    set_uniform(program, "sky_ambient", frame.sky_ambient);
    set_uniform(program, "ground_ambient", frame.ground_ambient);
    set_uniform(program, "key_towards", to_floats(frame.key.towards_ws.normalized()));
    set_uniform(program, "key_color", frame.key.color);
    set_uniform(program, "cs_to_shadow", shadow.cs_to_texture);
    set_uniform(program, "shadow_texel", 1.0F / static_cast<float>(k_shadow_size_px));
    set_uniform(program, "shadow_bias_m", static_cast<float>(1.5 * shadow.texel_m));
    set_uniform(program, "head_light", frame.head_light);
    set_uniform(program, "exposure", frame.exposure);
    set_uniform(program, "haze_per_m", frame.haze_per_m);
    set_uniform(program, "haze", frame.haze);
    const std::vector<Lamp> lamps = choose_lamps(frame, k_max_lamps);
    std::array<float, 4 * k_max_lamps> places{};
    std::array<float, 3 * k_max_lamps> colors{};
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const std::array<float, 3> place = to_floats(lamps[i].position_ws - view.eye_ws);
        std::copy(place.begin(), place.end(), places.begin() + static_cast<std::ptrdiff_t>(4 * i));
        places[4 * i + 3] = static_cast<float>(1.0 / (lamps[i].reach_m * lamps[i].reach_m));
        std::copy(lamps[i].color.begin(), lamps[i].color.end(),
                  colors.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    glUniform4fv(glGetUniformLocation(program, "lamp_place"), k_max_lamps, places.data());
    glUniform3fv(glGetUniformLocation(program, "lamp_color"), k_max_lamps, colors.data());
    set_uniform(program, "lamp_count", static_cast<int>(lamps.size()));
    glActiveTexture(GL_TEXTURE0 + k_shadow_unit);
    glBindTexture(GL_TEXTURE_2D, shadow_map);
    set_uniform(program, "shadow_map", k_shadow_unit);
}

void Renderer::Impl::draw_surface(const Visible& item) {
    const Look& look = item.instance->look;
    set_uniform(mesh_program, "albedo", item.instance->color.value_or(item.mesh->color));
    set_uniform(mesh_program, "emissive", look.emissive);
    set_uniform(mesh_program, "opacity", look.opacity);
    set_uniform(mesh_program, "gloss", look.gloss);
    draw_mesh(mesh_program, item);
}

// Depth pass first: shading dominates the cost, and hidden pixels are then not shaded.
void Renderer::Impl::draw_opaque(const FrameView& view) {
    const auto is_drawn = [&](const Visible& item) {
        return item.instance->look.opacity >= 1.0F &&
               sees_sphere(view, item.center_cs, item.mesh->radius_m);
    };
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glUseProgram(depth_program);
    set_uniform(depth_program, "cs_to_clip", view.cs_to_clip);
    for (const Visible& item : visible) {
        if (is_drawn(item)) {
            draw_mesh(depth_program, item);
        }
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glUseProgram(mesh_program);
    for (const Visible& item : visible) {
        if (is_drawn(item)) {
            draw_surface(item);
            ++counters.instances_seen;
        }
    }
    glDepthMask(GL_TRUE);
}

void Renderer::Impl::draw_glass(const FrameView& view) {
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glUseProgram(mesh_program);
    for (std::size_t i = visible.size(); i-- > 0;) {  // farthest first
        const Visible& item = visible[i];
        if (item.instance->look.opacity < 1.0F &&
            sees_sphere(view, item.center_cs, item.mesh->radius_m)) {
            draw_surface(item);
            ++counters.instances_seen;
        }
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void Renderer::Impl::draw_backdrop(const RenderFrame& frame, const FrameView& view) const {
    if (frame.backdrop == Backdrop::plain) {
        return;
    }
    glUseProgram(backdrop_program);
    const Vec3 right = view.from_view * Vec3(view.half_width, 0.0, 0.0);
    const Vec3 up = view.from_view * Vec3(0.0, view.half_height, 0.0);
    set_uniform(backdrop_program, "view_right", to_floats(right));
    set_uniform(backdrop_program, "view_up", to_floats(up));
    set_uniform(backdrop_program, "view_forward",
                to_floats(view.from_view * Vec3(view.middle_x, view.middle_y, -1.0)));
    set_uniform(backdrop_program, "planet", to_floats(frame.planet_ws.normalized()));
    set_uniform(backdrop_program, "sun", to_floats(frame.key.towards_ws.normalized()));
    glBindVertexArray(empty_layout);
    glDepthMask(GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
}

void Renderer::Impl::draw_lines(const RenderFrame& frame, const FrameView& view) {
    line_vertices.clear();
    build_line_vertices(frame, view, {width_px, height_px}, line_vertices);
    if (line_vertices.empty()) {
        return;
    }
    constexpr float k_strength = 0.95F;
    const auto count = static_cast<GLsizei>(line_vertices.size());
    glBindVertexArray(line_layout);
    glBindBuffer(GL_ARRAY_BUFFER, line_buffer);
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(line_vertices.size() * sizeof(LineVertex)),
                 line_vertices.data(), GL_STREAM_DRAW);
    glUseProgram(line_program);
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    set_uniform(line_program, "strength", k_strength);
    glDrawArrays(GL_TRIANGLES, 0, count);
    glDepthFunc(GL_GREATER);
    set_uniform(line_program, "strength", frame.hidden_lines);
    glDrawArrays(GL_TRIANGLES, 0, count);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

std::optional<Renderer> Renderer::create(int width_px, int height_px, std::string& why_not,
                                         PictureQuality quality) {
    HH_CHECK(width_px >= 16 && width_px <= 8192, "width out of range", width_px);
    HH_CHECK(height_px >= 16 && height_px <= 8192, "height out of range", height_px);
    auto impl = std::make_unique<Impl>();
    impl->context = GlContext::create(why_not);
    if (impl->context == nullptr) {
        return std::nullopt;
    }
    impl->width_px = width_px;
    impl->height_px = height_px;
    const PictureSize size{width_px, height_px, quality == PictureQuality::fine ? 2 : 1,
                           quality != PictureQuality::plain};
    impl->casts_shadows = quality != PictureQuality::plain;
    if (!impl->create_programs(why_not) ||
        !impl->passes.create(impl->context->api(), size, why_not) ||
        !impl->ghosts.create(impl->context->api(), why_not)) {
        return std::nullopt;
    }
    impl->create_shadow_map();
    impl->create_line_layout();
    return Renderer(std::move(impl));
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;
Renderer::~Renderer() = default;

MeshId Renderer::add_mesh(const Mesh& mesh) {
    impl_->context->make_current();
    impl_->meshes.push_back(make_gpu_mesh(make_shading_mesh(mesh), mesh.color));
    return MeshId{static_cast<std::uint32_t>(impl_->meshes.size() - 1)};
}

MeshId Renderer::add_moving_mesh(std::span<const std::array<std::uint32_t, 3>> triangles,
                                 const Color& color) {
    impl_->context->make_current();
    ShadingMesh shading;
    for (const std::array<std::uint32_t, 3>& triangle : triangles) {
        shading.indices.insert(shading.indices.end(), triangle.begin(), triangle.end());
    }
    GpuMesh gpu = make_gpu_mesh(shading, color);
    gpu.vertices_named =
        shading.indices.empty()
            ? 0
            : *std::max_element(shading.indices.begin(), shading.indices.end()) + 1;
    gpu.index_count = 0;  // draws nothing until move_mesh sets vertices
    impl_->meshes.push_back(std::move(gpu));
    return MeshId{static_cast<std::uint32_t>(impl_->meshes.size() - 1)};
}

void Renderer::move_mesh(MeshId mesh, std::span<const Vec3> positions,
                         std::span<const Vec3> normals) {
    const auto index = static_cast<std::size_t>(mesh);
    HH_CHECK(index < impl_->meshes.size(), "no such mesh", index);
    GpuMesh& gpu = impl_->meshes[index];
    HH_CHECK(gpu.vertices_named > 0 && positions.size() >= gpu.vertices_named &&
                 positions.size() == normals.size(),
             "too few vertices or normals for a moving mesh", positions.size());
    impl_->context->make_current();
    move_gpu_mesh(positions, normals, impl_->moving_vertices, gpu);
}

void Renderer::draw_picture(const RenderFrame& frame, const UiPicture* ui) {
    Impl& impl = *impl_;
    impl.context->make_current();
    impl.counters = {};
    const FrameView view = make_frame_view(frame.camera, impl.width_px, impl.height_px);
    const ShadowView shadow = make_shadow_view(frame.key, view, k_shadow_size_px);
    impl.collect(frame, view);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    impl.draw_shadows(shadow);
    impl.passes.begin();
    glClearColor(to_srgb(frame.background[0]), to_srgb(frame.background[1]),
                 to_srgb(frame.background[2]), 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    impl.set_lights(frame, view, shadow);
    impl.draw_opaque(view);
    impl.draw_backdrop(frame, view);
    impl.draw_glass(view);
    impl.counters.draw_calls += impl.ghosts.draw(frame, view, impl.meshes, impl.passes);
    impl.draw_lines(frame, view);
    glBindVertexArray(impl.empty_layout);
    impl.passes.finish(view, frame.sheet ? &*frame.sheet : nullptr, ui);
}

void Renderer::draw(const RenderFrame& frame, Image& out, const UiPicture* ui) {
    draw_picture(frame, ui);
    impl_->passes.read(out);
}

void Renderer::draw_into(std::uint32_t texture, const RenderFrame& frame, Image* copy,
                         const UiPicture* ui) {
    draw_picture(frame, ui);
    impl_->passes.copy_into(texture);
    if (copy != nullptr) {
        impl_->passes.read(*copy);
    }
}

const GlContext& Renderer::context() const { return *impl_->context; }

const RenderCounters& Renderer::counters() const { return impl_->counters; }

}  // namespace handhold
