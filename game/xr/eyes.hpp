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

    // Draws both eyes into the runtime's pictures, from their predicted poses at `time`. Returns
    // false if the runtime does not know the poses or provides no picture.
    bool draw(XrSession session, XrSpace room, XrTime time, const DrawEye& draw_eye);
    // Layer of the last draw(), for xrEndFrame. Valid until the next draw().
    const XrCompositionLayerBaseHeader* layer() const;

  private:
    struct Eye {
        OwnedXrSwapchain swapchain;
        std::vector<XrSwapchainImageOpenGLKHR> images;
    };
    Eyes() = default;
    bool create_eye(XrSession session, Eye& eye, std::string& why_not) const;
    bool draw_eye_picture(std::size_t which, const XrView& view, const DrawEye& draw_eye) const;

    EyeSize size_;
    std::array<Eye, k_eye_count> eyes_;
    std::array<XrCompositionLayerProjectionView, k_eye_count> views_{};
    XrCompositionLayerProjection layer_{};
};

}  // namespace handhold
