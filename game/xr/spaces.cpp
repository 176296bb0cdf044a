#include "game/xr/spaces.hpp"

#include <algorithm>
#include <vector>

#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

bool make_space(XrSession session, XrReferenceSpaceType type, float below_m, OwnedXrSpace& space,
                std::string& why_not) {
    auto info = xr_struct<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
    info.referenceSpaceType = type;
    info.poseInReferenceSpace = k_xr_identity;
    info.poseInReferenceSpace.position.y = -below_m;
    return xr_succeeds(xrCreateReferenceSpace(session, &info, space.out()),
                       "xrCreateReferenceSpace", why_not);
}

}  // namespace

std::optional<HeadsetSpaces> make_headset_spaces(const HeadsetInstance& instance, XrSession session,
                                                 std::string& why_not) {
    std::uint32_t count = 0;
    std::vector<XrReferenceSpaceType> types;
    if (XR_SUCCEEDED(xrEnumerateReferenceSpaces(session, 0, &count, nullptr))) {
        types.resize(count);
        xrEnumerateReferenceSpaces(session, count, &count, types.data());
    }
    const auto has = [&](XrReferenceSpaceType type) {
        return std::ranges::find(types, type) != types.end();
    };
    HeadsetSpaces spaces;
    bool made = false;
    if (has(XR_REFERENCE_SPACE_TYPE_STAGE)) {
        spaces.room_name = "stage";
        spaces.room_type = XR_REFERENCE_SPACE_TYPE_STAGE;
        made = make_space(session, XR_REFERENCE_SPACE_TYPE_STAGE, 0.0F, spaces.room, why_not);
    }
#ifdef XR_EXT_local_floor
    if (!made && instance.features.local_floor) {
        spaces.room_name = "local floor";
        spaces.room_type = XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR_EXT;
        made = make_space(session, XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR_EXT, 0.0F, spaces.room,
                          why_not);
    }
#else
    static_cast<void>(instance);
#endif
    if (!made) {
        spaces.room_name = "local";
        spaces.room_type = XR_REFERENCE_SPACE_TYPE_LOCAL;
        made = make_space(session, XR_REFERENCE_SPACE_TYPE_LOCAL,
                          static_cast<float>(k_eye_height_m), spaces.room, why_not);
    }
    if (!made || !make_space(session, XR_REFERENCE_SPACE_TYPE_VIEW, 0.0F, spaces.head, why_not)) {
        return std::nullopt;
    }
    return spaces;
}

}  // namespace handhold
