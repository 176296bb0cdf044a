#pragma once

#include <optional>
#include <string>

#include "game/xr/instance.hpp"

namespace handhold {

// OpenXR's spaces of the tracked room, with the floor at y = 0, and of the head.
struct HeadsetSpaces {
    OwnedXrSpace room;
    OwnedXrSpace head;
    std::string room_name;  // name of the OpenXR space that serves as the room
    XrReferenceSpaceType room_type = XR_REFERENCE_SPACE_TYPE_LOCAL;
};
// `room` is the stage space if the runtime has it, else the local-floor space, else the local
// space. The origin of the local space is taken to be 1.6 m above the floor.
std::optional<HeadsetSpaces> make_headset_spaces(const HeadsetInstance& instance, XrSession session,
                                                 std::string& why_not);

}  // namespace handhold
