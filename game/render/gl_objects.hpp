#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <epoxy/gl.h>

#include "game/render/gl_context.hpp"

// RAII owners of OpenGL names. Only included by sources of game/render: no other header exposes an
// OpenGL type.
namespace handhold {

// Owns one name and frees it with `Free`. The context that created it must be current on
// destruction.
template <auto Free>
class GlName {
  public:
    GlName() = default;
    explicit GlName(GLuint name) : name_(name) {}
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlName() {
        if (name_ != 0U) {
            Free(name_);
        }
    }
    operator GLuint() const { return name_; }  // NOLINT(google-explicit-constructor)

  private:
    GLuint name_ = 0;
};

inline void free_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void free_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void free_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void free_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void free_program(GLuint name) { glDeleteProgram(name); }

using GlBuffer = GlName<free_buffer>;
using GlVertexArray = GlName<free_vertex_array>;
using GlTexture = GlName<free_texture>;
using GlFramebuffer = GlName<free_framebuffer>;
using GlProgram = GlName<free_program>;

GlBuffer make_buffer();
GlVertexArray make_vertex_array();

// Storage format and filter of a texture.
struct TextureKind {
    GLint internal_format = GL_RGBA8;
    GLenum format = GL_RGBA;
    GLenum type = GL_UNSIGNED_BYTE;
    GLint filter = GL_LINEAR;
};
inline constexpr TextureKind k_color_texture{};
inline constexpr TextureKind k_depth_texture{GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT,
                                             GL_UNSIGNED_INT, GL_NEAREST};
GlTexture make_texture(int width_px, int height_px, const TextureKind& kind);

// A framebuffer with these attachments; 0 omits one.
GlFramebuffer make_framebuffer(GLuint color_texture, GLuint depth_texture);
// Checks the current draw framebuffer.
bool is_framebuffer_complete();

// Compiles and links a program. `vertex` and `fragment` have no version line. On failure returns
// name 0, and the compiler's message in `why_not`.
GlProgram make_program(GlApi api, std::string_view vertex, std::string_view fragment,
                       std::string& why_not);

// Sets uniforms of the program in use by name; names that the compiler removed are ignored.
void set_uniform(GLuint program, const char* name, float value);
void set_uniform(GLuint program, const char* name, int value);
void set_uniform(GLuint program, const char* name, const std::array<float, 2>& value);
void set_uniform(GLuint program, const char* name, const std::array<float, 3>& value);
void set_uniform(GLuint program, const char* name, const std::array<float, 4>& value);
void set_uniform(GLuint program, const char* name, const std::array<float, 16>& column_major);

}  // namespace handhold
