#pragma once

#include <array>
#include <optional>
#include <string>

#include "game/headset/headset_reading.hpp"
#include "game/xr/bindings.hpp"
#include "game/xr/instance.hpp"

namespace handhold {

// The controllers: an action set with suggestions for every profile of bindings.hpp, attached to a
// session. The session must outlive it.
class HeadsetActions {
  public:
    static std::optional<HeadsetActions> create(const HeadsetInstance& instance, XrSession session,
                                                std::string& why_not);

    // Asks the runtime what is pressed; false where it has no focus: all is let go then.
    XrResult sync(XrSession session);
    // As of the last sync; poses as predicted for `time`, relative to `base`.
    void read(XrSession session, XrSpace base, XrTime time,
              std::array<HandReading, k_hand_count>& hands) const;
    void shake(XrSession session, HandSide side, const HapticPulse& pulse) const;

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
    std::optional<Pose> pose(XrSession session, HeadsetAction which, std::size_t side, XrSpace base,
                             XrTime time) const;

    OwnedXrActionSet set_;
    std::array<XrAction, k_headset_action_count> actions_{};  // destroyed with their set
    std::array<XrPath, k_hand_count> hands_{};
    // Of the three poses, by HeadsetAction and HandSide.
    std::array<std::array<OwnedXrSpace, k_hand_count>, 3> spaces_;
};

// Where `space` is in `base`; nothing where that is not tracked or not known.
std::optional<Pose> locate(XrSpace space, XrSpace base, XrTime time);

}  // namespace handhold
