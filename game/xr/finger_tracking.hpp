#pragma once

#include <array>
#include <string>

#include "game/devices/headset_reading.hpp"
#include "game/xr/instance.hpp"

namespace handhold {

// Finger tracking by cameras or controllers (XR_EXT_hand_tracking): the wrist's pose, and how far
// the fingers are curled. Instance and session must outlive this object.
class FingerTracking {
  public:
    FingerTracking() = default;  // reads every hand as not tracked
    ~FingerTracking();
    FingerTracking(FingerTracking&& other) noexcept;
    FingerTracking& operator=(FingerTracking&& other) noexcept;

    // If the runtime has no finger tracking, every hand is read as not tracked.
    static FingerTracking create(const HeadsetInstance& instance, XrSession session);
    void read(XrSpace base, XrTime time, std::array<HandReading, 2>& hands) const;

  private:
    void read_hand(std::size_t side, XrSpace base, XrTime time, HandReading& hand) const;

    PFN_xrLocateHandJointsEXT locate_ = nullptr;
    PFN_xrDestroyHandTrackerEXT destroy_ = nullptr;
    std::array<XrHandTrackerEXT, 2> trackers_{};
};

}  // namespace handhold
