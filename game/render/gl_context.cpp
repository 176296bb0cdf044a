#include "game/render/gl_context.hpp"

#include <array>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace handhold {
namespace {

EGLDisplay open_display(std::string& why_not) {
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        why_not = "EGL does not support the surfaceless platform";
        return EGL_NO_DISPLAY;
    }
    EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
        why_not = "EGL's surfaceless display cannot be initialised";
        return EGL_NO_DISPLAY;
    }
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
        why_not = "EGL does not support contexts without a surface";
        return EGL_NO_DISPLAY;
    }
    return display;
}

}  // namespace

std::unique_ptr<GlContext> GlContext::create(std::string& why_not) {
    if (!epoxy_has_egl()) {
        why_not = "no EGL library";
        return nullptr;
    }
    std::unique_ptr<GlContext> context(new GlContext);
    context->display_ = open_display(why_not);
    if (context->display_ == EGL_NO_DISPLAY) {
        return nullptr;
    }
    if (!context->try_api(GlApi::desktop_33) && !context->try_api(GlApi::es_30)) {
        why_not = "EGL offers neither OpenGL 3.3 core nor OpenGL ES 3.0";
        return nullptr;
    }
    return context;
}

bool GlContext::try_api(GlApi api) {
    const bool is_desktop = api == GlApi::desktop_33;
    if (eglBindAPI(is_desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API) != EGL_TRUE) {
        return false;
    }
    const std::array<EGLint, 5> wanted = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE,
                                          is_desktop ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT,
                                          EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
        return false;
    }
    const std::array<EGLint, 7> desktop = {EGL_CONTEXT_MAJOR_VERSION,
                                           3,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           3,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    const std::array<EGLint, 3> embedded = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT,
                                is_desktop ? desktop.data() : embedded.data());
    config_ = config;
    api_ = api;
    if (context_ != EGL_NO_CONTEXT && make_current()) {
        return true;
    }
    if (context_ != EGL_NO_CONTEXT) {
        eglDestroyContext(display_, context_);
        context_ = EGL_NO_CONTEXT;
    }
    return false;
}

bool GlContext::make_current() {
    // The bound API is per thread and determines which current context eglMakeCurrent replaces.
    eglBindAPI(api_ == GlApi::desktop_33 ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
    return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

GlContext::Handles GlContext::handles() const {
    return {display_, config_, context_, eglGetProcAddress};
}

GlContext::~GlContext() {
    if (context_ != EGL_NO_CONTEXT) {
        if (eglGetCurrentContext() == context_) {
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglDestroyContext(display_, context_);
    }
}

}  // namespace handhold
