#include "game/xr/eyes.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr XrViewConfigurationType k_stereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr std::int64_t k_gl_srgb8_alpha8 = 0x8C43;

EyeFrustum frustum_of(const XrFovf& fov) {
    const auto tangent = [](float angle_rad) { return std::tan(static_cast<double>(angle_rad)); };
    return {tangent(fov.angleLeft), tangent(fov.angleRight), tangent(fov.angleDown),
            tangent(fov.angleUp)};
}

}  // namespace

EyeSizes eye_sizes_of(const HeadsetInstance& instance) {
    std::array<XrViewConfigurationView, k_eye_count> views;
    views.fill(xr_struct<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
    std::uint32_t count = 0;
    if (XR_FAILED(xrEnumerateViewConfigurationViews(instance.instance.get(), instance.system,
                                                    k_stereo, k_eye_count, &count, views.data())) ||
        count != k_eye_count) {
        return {};
    }
    const auto size = [](std::uint32_t width_px, std::uint32_t height_px) {
        constexpr std::uint32_t k_max_px = 16384;
        return EyeSize{static_cast<int>(std::min(width_px, k_max_px)),
                       static_cast<int>(std::min(height_px, k_max_px))};
    };
    return {size(views[0].recommendedImageRectWidth, views[0].recommendedImageRectHeight),
            size(views[0].maxImageRectWidth, views[0].maxImageRectHeight)};
}

std::optional<Eyes> Eyes::create(XrSession session, const EyeSize& size, std::string& why_not) {
    std::uint32_t count = 0;
    std::vector<std::int64_t> formats;
    if (XR_SUCCEEDED(xrEnumerateSwapchainFormats(session, 0, &count, nullptr))) {
        formats.resize(count);
        xrEnumerateSwapchainFormats(session, count, &count, formats.data());
    }
    if (std::ranges::find(formats, k_gl_srgb8_alpha8) == formats.end()) {
        why_not = "the OpenXR runtime takes no sRGB pictures of eight bits";
        return std::nullopt;
    }
    Eyes made;
    made.size_ = size;
    for (Eye& eye : made.eyes_) {
        if (!made.create_eye(session, eye, why_not)) {
            return std::nullopt;
        }
    }
    return made;
}

bool Eyes::create_eye(XrSession session, Eye& eye, std::string& why_not) const {
    auto info = xr_struct<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = k_gl_srgb8_alpha8;
    info.sampleCount = 1;
    info.width = static_cast<std::uint32_t>(size_.width_px);
    info.height = static_cast<std::uint32_t>(size_.height_px);
    info.faceCount = 1;
    info.arraySize = 1;
    info.mipCount = 1;
    if (!xr_succeeds(xrCreateSwapchain(session, &info, eye.swapchain.out()), "xrCreateSwapchain",
                     why_not)) {
        return false;
    }
    std::uint32_t count = 0;
    const XrSwapchain swapchain = eye.swapchain.get();
    if (!xr_succeeds(xrEnumerateSwapchainImages(swapchain, 0, &count, nullptr),
                     "xrEnumerateSwapchainImages", why_not)) {
        return false;
    }
    eye.images.assign(count,
                      xr_struct<XrSwapchainImageOpenGLKHR>(XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
    return xr_succeeds(xrEnumerateSwapchainImages(swapchain, count, &count,
                                                  reinterpret_cast<XrSwapchainImageBaseHeader*>(
                                                      eye.images.data())),  // NOLINT: OpenXR
                       "xrEnumerateSwapchainImages", why_not);
}

bool Eyes::draw_eye_picture(std::size_t which, const XrView& view, const hh::Pose& eye_ps,
                            const DrawEye& draw_eye) const {
    const Eye& eye = eyes_[which];
    std::uint32_t image = 0;
    if (XR_FAILED(xrAcquireSwapchainImage(eye.swapchain.get(), nullptr, &image))) {
        return false;
    }
    auto wait = xr_struct<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
    wait.timeout = XR_INFINITE_DURATION;
    const bool lent = XR_SUCCEEDED(xrWaitSwapchainImage(eye.swapchain.get(), &wait));
    if (lent) {
        draw_eye({which, eye_ps, frustum_of(view.fov), eye.images[image].image, size_});
    }
    return XR_SUCCEEDED(xrReleaseSwapchainImage(eye.swapchain.get(), nullptr)) && lent;
}

bool Eyes::draw(XrSession session, const Place& place, XrTime time, const DrawEye& draw_eye) {
    auto info = xr_struct<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    info.viewConfigurationType = k_stereo;
    info.displayTime = time;
    info.space = place.room;
    auto state = xr_struct<XrViewState>(XR_TYPE_VIEW_STATE);
    std::array<XrView, k_eye_count> views;
    views.fill(xr_struct<XrView>(XR_TYPE_VIEW));
    std::uint32_t count = 0;
    constexpr XrViewStateFlags k_known =
        XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT;
    if (XR_FAILED(xrLocateViews(session, &info, &state, k_eye_count, &count, views.data())) ||
        count != k_eye_count || (state.viewStateFlags & k_known) != k_known) {
        return false;
    }
    for (std::size_t which = 0; which < k_eye_count; ++which) {
        const hh::Pose eye_ps = place.room_in_readings * from_xr(views[which].pose);
        if (!draw_eye_picture(which, views[which], eye_ps, draw_eye)) {
            return false;
        }
        auto& shown = views_[which];
        shown =
            xr_struct<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
        shown.pose = views[which].pose;
        shown.fov = views[which].fov;
        shown.subImage.swapchain = eyes_[which].swapchain.get();
        shown.subImage.imageRect = {{0, 0}, {size_.width_px, size_.height_px}};
    }
    layer_ = xr_struct<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
    layer_.space = place.room;
    layer_.viewCount = k_eye_count;
    layer_.views = views_.data();
    return true;
}

const XrCompositionLayerBaseHeader* Eyes::layer() const {
    return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer_);  // NOLINT: OpenXR API
}

}  // namespace handhold
