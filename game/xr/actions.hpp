#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "game/devices/headset_reading.hpp"
#include "game/xr/bindings.hpp"
#include "game/xr/instance.hpp"

namespace handhold {

// Runtimes infer poses of devices that they do not see, as from the head: valid but not tracked.
// Such a hand would drag a gripping player who looks round.
struct LocatedPose {
    hh::Pose pose;
    bool is_inferred = false;
};
constexpr XrSpaceLocationFlags k_valid_location =
    XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
constexpr bool is_valid_location(XrSpaceLocationFlags flags) {
    return (flags & k_valid_location) == k_valid_location;
}
constexpr bool is_inferred_location(XrSpaceLocationFlags flags) {
    return (flags & XR_SPACE_LOCATION_POSITION_TRACKED_BIT) == 0;
}

// Input from controllers, and their vibration: an OpenXR action set that is attached to a session
// and suggests bindings for every profile of bindings.hpp. The session must outlive this object.
class HeadsetActions {
  public:
    static std::optional<HeadsetActions> create(const HeadsetInstance& instance, XrSession session,
                                                std::string& why_not);

    // Updates the state of buttons and sticks. Returns XR_SESSION_NOT_FOCUSED if the session has no
    // focus; all buttons count as released then.
    XrResult sync(XrSession session);
    // Reads buttons and sticks as of the last sync(), and the poses predicted for `time` in `base`.
    void read(XrSession session, XrSpace base, XrTime time,
              std::array<HandReading, 2>& hands) const;
    void shake(XrSession session, hh::Side side, const HapticPulse& pulse) const;

  private:
    HeadsetActions() = default;
    bool create_actions(bool has_palms, std::string& why_not);
    bool suggest(XrInstance instance, bool has_palms, std::string& why_not) const;
    bool create_spaces(XrSession session, std::string& why_not);
    XrAction action(HeadsetAction which) const { return actions_[static_cast<std::size_t>(which)]; }
    double number(XrSession session, HeadsetAction which, std::size_t side) const;
    bool button(XrSession session, HeadsetAction which, std::size_t side) const;
    std::array<double, 2> stick(XrSession session, std::size_t side) const;
    bool is_active(XrSession session, HeadsetAction which, std::size_t side) const;
    std::optional<LocatedPose> pose(XrSession session, HeadsetAction which, std::size_t side,
                                    XrSpace base, XrTime time) const;

    OwnedXrActionSet set_;
    std::array<XrAction, k_headset_action_count> actions_{};  // destroyed with their set
    std::array<XrPath, 2> hands_{};
    // Spaces of the three pose actions, by HeadsetAction and HandSide.
    std::array<std::array<OwnedXrSpace, 2>, 3> spaces_;
};

// Pose of `space` in `base` at `time`; nullopt if the runtime does not know it.
std::optional<LocatedPose> locate(XrSpace space, XrSpace base, XrTime time);

}  // namespace handhold
