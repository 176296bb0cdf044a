#pragma once

#include <optional>
#include <string>

#include "game/xr/xr_api.hpp"

namespace handhold {

// Optional OpenXR extensions that the game uses if the runtime has them.
struct HeadsetFeatures {
    bool headless = false;
    bool opengl_egl = false;
    bool local_floor = false;
    bool hand_tracking = false;
    bool palm_pose = false;
    bool time_conversion = false;
};

// A connection to the machine's OpenXR runtime and its headset.
struct HeadsetInstance {
    OwnedXrInstance instance;
    XrSystemId system = XR_NULL_SYSTEM_ID;
    HeadsetFeatures features;
    std::string runtime_name;  // name with version
    std::string system_name;
};

// Returns nullopt, with a reason of one line, if there is no runtime or no headset, or if the
// runtime lacks an extension that drawing (headless: a session without pictures) needs.
std::optional<HeadsetInstance> open_headset_instance(bool headless, std::string& why_not);

}  // namespace handhold
