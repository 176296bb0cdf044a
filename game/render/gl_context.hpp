#pragma once

#include <memory>
#include <string>

namespace handhold {

enum class GlApi { desktop_33, es_30 };

// An OpenGL context without a window. The only place that names EGL.
class GlContext {
  public:
    // Nothing, and the reason, where there is no such thing on this machine. The new context is
    // current.
    static std::unique_ptr<GlContext> create(std::string& why_not);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    // Makes it the calling thread's context. False where another thread holds it.
    bool make_current();
    GlApi api() const { return api_; }

    // EGL's own, for a library that shares the context.
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

    void* display_ =
        nullptr;  // shared by the whole process and never terminated: others may be using it
    void* config_ = nullptr;
    void* context_ = nullptr;
    GlApi api_ = GlApi::desktop_33;
};

}  // namespace handhold
