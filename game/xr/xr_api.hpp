#pragma once

// OpenXR with OpenGL through EGL: the one way in which its headers are included. API 1.0; what is
// newer than the headers of Debian 12 (1.0.20) stands behind #ifdef.
#include <ctime>
#include <string>
#include <utility>

#include <epoxy/egl.h>

// NOLINTBEGIN(readability-identifier-naming): OpenXR asks for them by these names
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
// NOLINTEND(readability-identifier-naming)
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include "engine/math/math.hpp"

namespace handhold {

// Owns a handle of OpenXR and destroys it with `Destroy`. What it was made from must outlive it.
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
    // For a function that makes one. Precondition: holds none.
    Handle* out() { return &handle_; }

  private:
    Handle handle_ = XR_NULL_HANDLE;
};

using OwnedXrInstance = XrOwned<XrInstance, &xrDestroyInstance>;
using OwnedXrSession = XrOwned<XrSession, &xrDestroySession>;
using OwnedXrSpace = XrOwned<XrSpace, &xrDestroySpace>;
using OwnedXrActionSet = XrOwned<XrActionSet, &xrDestroyActionSet>;
using OwnedXrSwapchain = XrOwned<XrSwapchain, &xrDestroySwapchain>;

// A structure of OpenXR with its type filled in.
template <class T>
T xr_struct(XrStructureType type) {
    T value{};
    value.type = type;
    return value;
}

// True where a call succeeded; else why_not has its name and the runtime's word for the result.
bool xr_succeeds(XrResult result, const char* call, std::string& why_not);

// A function of an extension; null where the runtime lacks it.
template <class Function>
Function xr_function(XrInstance instance, const char* name) {
    PFN_xrVoidFunction function = nullptr;
    if (XR_FAILED(xrGetInstanceProcAddr(instance, name, &function))) {
        return nullptr;
    }
    return reinterpret_cast<Function>(function);  // NOLINT: how OpenXR hands functions out
}

inline Pose from_xr(const XrPosef& pose) {
    const auto wide = [](float value) { return static_cast<double>(value); };
    return {Vec3(wide(pose.position.x), wide(pose.position.y), wide(pose.position.z)),
            Quat(wide(pose.orientation.w), wide(pose.orientation.x), wide(pose.orientation.y),
                 wide(pose.orientation.z))
                .normalized()};
}
inline constexpr XrPosef k_xr_identity = {{0.0F, 0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}};

}  // namespace handhold
