#include "game/render/gl_objects.hpp"

namespace handhold {
namespace {

GLuint compile(GLenum kind, GlApi api, std::string_view source, std::string& why_not) {
    const std::string_view version =
        api == GlApi::desktop_33
            ? "#version 330 core\n"
            : "#version 300 es\nprecision highp float;\nprecision highp sampler2DShadow;\n";
    const std::array<const GLchar*, 2> parts = {version.data(), source.data()};
    const std::array<GLint, 2> lengths = {static_cast<GLint>(version.size()),
                                          static_cast<GLint>(source.size())};
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 2, parts.data(), lengths.data());
    glCompileShader(shader);
    GLint is_compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled != GL_TRUE) {
        std::array<GLchar, 1024> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        why_not = std::string("shader: ") + log.data();
        glDeleteShader(shader);
        return 0;
    }
    return shader;
}

}  // namespace

GlBuffer make_buffer() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return GlBuffer(name);
}

GlVertexArray make_vertex_array() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return GlVertexArray(name);
}

GlTexture make_texture(int width_px, int height_px, const TextureKind& kind) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, kind.internal_format, width_px, height_px, 0, kind.format,
                 kind.type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, kind.filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, kind.filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return GlTexture(name);
}

GlFramebuffer make_framebuffer(GLuint color_texture, GLuint depth_texture) {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    if (color_texture != 0U) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_texture,
                               0);
    } else {
        const GLenum none = GL_NONE;
        glDrawBuffers(1, &none);
        glReadBuffer(GL_NONE);
    }
    if (depth_texture != 0U) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_texture,
                               0);
    }
    return GlFramebuffer(name);
}

bool is_framebuffer_complete() {
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

GlProgram make_program(GlApi api, std::string_view vertex, std::string_view fragment,
                       std::string& why_not) {
    const GLuint vertex_shader = compile(GL_VERTEX_SHADER, api, vertex, why_not);
    const GLuint fragment_shader =
        vertex_shader != 0U ? compile(GL_FRAGMENT_SHADER, api, fragment, why_not) : 0U;
    if (fragment_shader == 0U) {
        glDeleteShader(vertex_shader);
        return {};
    }
    GlProgram program(glCreateProgram());
    glAttachShader(program, vertex_shader);
    glAttachShader(program, fragment_shader);
    glLinkProgram(program);
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    GLint is_linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
    if (is_linked != GL_TRUE) {
        why_not = "the shader program failed to link";
        return {};
    }
    return program;
}

void set_uniform(GLuint program, const char* name, float value) {
    glUniform1f(glGetUniformLocation(program, name), value);
}
void set_uniform(GLuint program, const char* name, int value) {
    glUniform1i(glGetUniformLocation(program, name), value);
}
void set_uniform(GLuint program, const char* name, const std::array<float, 2>& value) {
    glUniform2fv(glGetUniformLocation(program, name), 1, value.data());
}
void set_uniform(GLuint program, const char* name, const std::array<float, 3>& value) {
    glUniform3fv(glGetUniformLocation(program, name), 1, value.data());
}
void set_uniform(GLuint program, const char* name, const std::array<float, 4>& value) {
    glUniform4fv(glGetUniformLocation(program, name), 1, value.data());
}
void set_uniform(GLuint program, const char* name, const std::array<float, 16>& column_major) {
    glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, column_major.data());
}

}  // namespace handhold
