#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "game/xr/headset.hpp"
#include "game/xr/instance.hpp"

namespace handhold {

// Recommended and largest size of each eye's picture; 0 if the runtime does not say.
EyeSizes eye_sizes_of(const HeadsetInstance& instance);

// Pictures of both eyes, in swapchains of the runtime. The session must outlive this object.
class Eyes {
  public:
    static std::optional<Eyes> create(XrSession session, const EyeSize& size, std::string& why_not);

    struct Place {
        XrSpace room = XR_NULL_HANDLE;
        hh::Pose room_in_readings = hh::k_origin;  // room's space in that of the readings
    };
    // Draws both eyes at their poses for `time` into pictures of the runtime. False if the runtime
    // gives no poses or lends no picture.
    bool draw(XrSession session, const Place& place, XrTime time, const DrawEye& draw_eye);
    // What draw() made, for the end of a frame. Valid until the next draw().
    const XrCompositionLayerBaseHeader* layer() const;

  private:
    struct Eye {
        OwnedXrSwapchain swapchain;
        std::vector<XrSwapchainImageOpenGLKHR> images;
    };
    Eyes() = default;
    bool create_eye(XrSession session, Eye& eye, std::string& why_not) const;
    bool draw_eye_picture(std::size_t which, const XrView& view, const hh::Pose& eye_ps,
                          const DrawEye& draw_eye) const;

    EyeSize size_;
    std::array<Eye, k_eye_count> eyes_;
    std::array<XrCompositionLayerProjectionView, k_eye_count> views_{};
    XrCompositionLayerProjection layer_{};
};

}  // namespace handhold
