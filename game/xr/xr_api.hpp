#pragma once

// Includes OpenXR's headers, for OpenGL through EGL; the only file that does. Uses API 1.0. Code
// for anything newer than Debian 12's headers (1.0.20) is inside #ifdef.
#include <ctime>
#include <string>
#include <utility>

#include <epoxy/egl.h>

// NOLINTBEGIN(readability-identifier-naming): OpenXR asks for them by these names
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
// NOLINTEND(readability-identifier-naming)
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace handhold {

// Owns an OpenXR handle and destroys it with `Destroy`. The object that it was created from must
// outlive it.
template <class Handle, auto Destroy>
class XrOwned {
  public:
    XrOwned() = default;
    explicit XrOwned(Handle handle) : handle_(handle) {}
    XrOwned(XrOwned&& other) noexcept : handle_(std::exchange(other.handle_, Handle{})) {}
    XrOwned& operator=(XrOwned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~XrOwned() {
        if (handle_ != XR_NULL_HANDLE) {
            Destroy(handle_);
        }
    }
    Handle get() const { return handle_; }
    explicit operator bool() const { return handle_ != XR_NULL_HANDLE; }
    // Output argument for a function that creates a handle. Precondition: holds none.
    Handle* out() { return &handle_; }

  private:
    Handle handle_ = XR_NULL_HANDLE;
};

using OwnedXrInstance = XrOwned<XrInstance, &xrDestroyInstance>;
using OwnedXrSession = XrOwned<XrSession, &xrDestroySession>;
using OwnedXrSpace = XrOwned<XrSpace, &xrDestroySpace>;
using OwnedXrActionSet = XrOwned<XrActionSet, &xrDestroyActionSet>;
using OwnedXrSwapchain = XrOwned<XrSwapchain, &xrDestroySwapchain>;

// An OpenXR structure with its type filled in.
template <class T>
T xr_struct(XrStructureType type) {
    T value{};
    value.type = type;
    return value;
}

// Returns true if the call succeeded; else sets why_not to the call's name and the meaning of the
// result.
bool xr_succeeds(XrResult result, const char* call, std::string& why_not);

// A function of an extension; null if the runtime lacks it.
template <class Function>
Function xr_function(XrInstance instance, const char* name) {
    PFN_xrVoidFunction function = nullptr;
    if (XR_FAILED(xrGetInstanceProcAddr(instance, name, &function))) {
        return nullptr;
    }
    return reinterpret_cast<Function>(function);  // NOLINT: how OpenXR hands functions out
}

inline hh::Pose from_xr(const XrPosef& pose) {
    const auto wide = [](float value) { return static_cast<double>(value); };
    return {hh::Vec3{wide(pose.position.x), wide(pose.position.y), wide(pose.position.z)},
            hh::normalized(hh::Quat{wide(pose.orientation.x), wide(pose.orientation.y),
                                    wide(pose.orientation.z), wide(pose.orientation.w)})};
}
inline constexpr XrPosef k_xr_identity = {{0.0F, 0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}};

}  // namespace handhold
