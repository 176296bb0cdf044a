#include "game/xr/instance.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

namespace handhold {
namespace {

constexpr const char* k_local_floor = "XR_EXT_local_floor";
constexpr const char* k_palm_pose = "XR_EXT_palm_pose";
constexpr const char* k_time_conversion = "XR_KHR_convert_timespec_time";

std::string version_text(XrVersion version) {
    return std::to_string(XR_VERSION_MAJOR(version)) + "." +
           std::to_string(XR_VERSION_MINOR(version)) + "." +
           std::to_string(XR_VERSION_PATCH(version));
}

bool list_extensions(std::vector<XrExtensionProperties>& extensions, std::string& why_not) {
    std::uint32_t count = 0;
    XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
    if (XR_SUCCEEDED(result)) {
        extensions.assign(count, xr_struct<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
        result = xrEnumerateInstanceExtensionProperties(nullptr, count, &count, extensions.data());
        extensions.resize(XR_SUCCEEDED(result) ? count : 0);
    }
    if (result == XR_ERROR_RUNTIME_UNAVAILABLE) {
        why_not = "no OpenXR runtime: none is active on this machine";
        return false;
    }
    if (!xr_succeeds(result, "xrEnumerateInstanceExtensionProperties", why_not)) {
        why_not = "no OpenXR runtime: " + why_not;
        return false;
    }
    return true;
}

// Extensions to enable: those that the runtime has (`there`) and this kind of session uses.
std::vector<const char*> choose_extensions(const std::vector<XrExtensionProperties>& there,
                                           bool headless, HeadsetFeatures& features) {
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(there,
                                   [&](const auto& each) { return name == each.extensionName; });
    };
    std::vector<const char*> chosen;
    const auto ask = [&](bool wanted, const char* name) {
        const bool found = wanted && has(name);
        if (found) {
            chosen.push_back(name);
        }
        return found;
    };
    features.headless = ask(headless, XR_MND_HEADLESS_EXTENSION_NAME);
    features.opengl_egl = !headless && has(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME) &&
                          ask(true, XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
    ask(features.opengl_egl, XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
    features.time_conversion = ask(headless, k_time_conversion);
#ifdef XR_EXT_local_floor
    features.local_floor = ask(true, k_local_floor);
#else
    static_cast<void>(k_local_floor);
#endif
    features.hand_tracking = ask(true, XR_EXT_HAND_TRACKING_EXTENSION_NAME);
    features.palm_pose = ask(true, k_palm_pose);  // the extension adds only a path
    return chosen;
}

bool create_instance(const std::vector<const char*>& extensions, HeadsetInstance& made,
                     std::string& why_not) {
    auto info = xr_struct<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
    std::strncpy(info.applicationInfo.applicationName, "Handhold",
                 XR_MAX_APPLICATION_NAME_SIZE - 1);
    std::strncpy(info.applicationInfo.engineName, "Handhold", XR_MAX_ENGINE_NAME_SIZE - 1);
    info.applicationInfo.applicationVersion = 1;
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.enabledExtensionNames = extensions.data();
    const XrResult result = xrCreateInstance(&info, made.instance.out());
    if (!xr_succeeds(result, "xrCreateInstance", why_not)) {
        why_not = "no OpenXR runtime: " + why_not + ": it is installed but does not answer";
        return false;
    }
    auto properties = xr_struct<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
    if (XR_SUCCEEDED(xrGetInstanceProperties(made.instance.get(), &properties))) {
        made.runtime_name =
            std::string(properties.runtimeName) + " " + version_text(properties.runtimeVersion);
    }
    return true;
}

bool find_system(HeadsetInstance& made, std::string& why_not) {
    auto info = xr_struct<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
    info.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    const XrResult result = xrGetSystem(made.instance.get(), &info, &made.system);
    if (!xr_succeeds(result, "xrGetSystem", why_not)) {
        why_not = "no headset: " + why_not + ", says " + made.runtime_name;
        return false;
    }
    auto properties = xr_struct<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
    auto hands =
        xr_struct<XrSystemHandTrackingPropertiesEXT>(XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT);
    properties.next = made.features.hand_tracking ? &hands : nullptr;
    if (XR_SUCCEEDED(xrGetSystemProperties(made.instance.get(), made.system, &properties))) {
        made.system_name = properties.systemName;
        made.features.hand_tracking =
            made.features.hand_tracking && hands.supportsHandTracking == XR_TRUE;
    }
    return true;
}

}  // namespace

bool xr_succeeds(XrResult result, const char* call, std::string& why_not) {
    if (XR_SUCCEEDED(result)) {
        return true;
    }
    // xrResultToString needs an instance, and there may be none yet.
    static constexpr std::pair<XrResult, const char*> k_names[] = {
        {XR_ERROR_RUNTIME_FAILURE, "the runtime fails"},
        {XR_ERROR_RUNTIME_UNAVAILABLE, "no runtime answers"},
        {XR_ERROR_OUT_OF_MEMORY, "out of memory"},
        {XR_ERROR_INSTANCE_LOST, "the runtime is gone"},
        {XR_ERROR_SESSION_LOST, "the session is lost"},
        {XR_ERROR_FORM_FACTOR_UNSUPPORTED, "headsets are not its kind of device"},
        {XR_ERROR_FORM_FACTOR_UNAVAILABLE, "no headset is plugged in"},
        {XR_ERROR_GRAPHICS_DEVICE_INVALID, "it refuses this graphics context"},
        {XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING, "graphics requirements were not asked for"},
        {XR_ERROR_API_VERSION_UNSUPPORTED, "it knows no OpenXR 1.0"},
        {XR_ERROR_EXTENSION_NOT_PRESENT, "it lacks an extension that it names"},
        {XR_ERROR_PATH_UNSUPPORTED, "it does not know a path"},
        {XR_ERROR_LIMIT_REACHED, "its limit is reached"},
    };
    const auto* const found = std::ranges::find(
        k_names, result, [](const std::pair<XrResult, const char*>& each) { return each.first; });
    why_not =
        std::string(call) + ": " +
        (found != std::end(k_names) ? found->second : "OpenXR's result " + std::to_string(result));
    return false;
}

std::optional<HeadsetInstance> open_headset_instance(bool headless, std::string& why_not) {
    // Keeps the loader from printing a page if there is no runtime. Users who want the page set the
    // variable themselves.
    constexpr int k_keep = 0;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody else reads the environment meanwhile
    ::setenv("XR_LOADER_DEBUG", "none", k_keep);
    std::vector<XrExtensionProperties> there;
    if (!list_extensions(there, why_not)) {
        return std::nullopt;
    }
    HeadsetInstance made;
    const std::vector<const char*> extensions = choose_extensions(there, headless, made.features);
    if (headless && !(made.features.headless && made.features.time_conversion)) {
        why_not = "the OpenXR runtime knows no session without pictures (XR_MND_headless)";
        return std::nullopt;
    }
    if (!headless && !made.features.opengl_egl) {
        why_not = "the OpenXR runtime takes no OpenGL pictures through EGL (XR_MNDX_egl_enable)";
        return std::nullopt;
    }
    if (!create_instance(extensions, made, why_not) || !find_system(made, why_not)) {
        return std::nullopt;
    }
    return made;
}

}  // namespace handhold
