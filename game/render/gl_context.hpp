#pragma once

#include <memory>
#include <string>

namespace handhold {

enum class GlApi { desktop_33, es_30 };

// An OpenGL context without a window. The only class that uses EGL.
class GlContext {
  public:
    // Null, with the reason in `why_not`, if the machine has no suitable EGL. The new context is
    // current.
    static std::unique_ptr<GlContext> create(std::string& why_not);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    // Makes this the calling thread's context. False if another thread holds it.
    bool make_current();
    GlApi api() const { return api_; }

    // EGL's handles, for a library that shares the context.
    struct Handles {
        void* display = nullptr;
        void* config = nullptr;
        void* context = nullptr;
        void (*(*get_proc_address)(const char*))() = nullptr;
    };
    Handles handles() const;

  private:
    GlContext() = default;
    bool try_api(GlApi api);

    // The whole process uses one display. It is never terminated, because other contexts may use
    // it.
    void* display_ = nullptr;
    void* config_ = nullptr;
    void* context_ = nullptr;
    GlApi api_ = GlApi::desktop_33;
};

}  // namespace handhold
