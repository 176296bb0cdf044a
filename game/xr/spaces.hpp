#pragma once

#include <optional>
#include <string>

#include "game/xr/instance.hpp"

namespace handhold {

// The room that the headset tracks, its floor at y = 0, and the head in it.
struct HeadsetSpaces {
    OwnedXrSpace room;
    OwnedXrSpace head;
    std::string room_name;  // which of OpenXR's spaces the room is
    XrReferenceSpaceType room_type = XR_REFERENCE_SPACE_TYPE_LOCAL;
};
// The stage, else what lies on the floor, else what begins at the eyes, an upright person's height
// above the floor.
std::optional<HeadsetSpaces> make_headset_spaces(const HeadsetInstance& instance, XrSession session,
                                                 std::string& why_not);

}  // namespace handhold
