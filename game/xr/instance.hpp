#pragma once

#include <optional>
#include <string>

#include "game/xr/xr_api.hpp"

namespace handhold {

// What a runtime has beyond OpenXR's core that the game uses where it is there.
struct HeadsetFeatures {
    bool headless = false;
    bool opengl_egl = false;
    bool local_floor = false;
    bool hand_tracking = false;
    bool palm_pose = false;
    bool time_conversion = false;
};

// A connection to the machine's OpenXR runtime, and the headset that it knows.
struct HeadsetInstance {
    OwnedXrInstance instance;
    XrSystemId system = XR_NULL_SYSTEM_ID;
    HeadsetFeatures features;
    std::string runtime_name;  // with its version
    std::string system_name;
};

// Nothing, with the reason in one line, where there is no runtime, no headset, or not what drawing
// (or, headless, being without pictures) takes.
std::optional<HeadsetInstance> open_headset_instance(bool headless, std::string& why_not);

}  // namespace handhold
