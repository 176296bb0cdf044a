#pragma once

#include <array>
#include <string>

#include "game/headset/headset_reading.hpp"
#include "game/xr/instance.hpp"

namespace handhold {

// Fingers that cameras or controllers see (XR_EXT_hand_tracking): where the wrist is and how far
// the fingers are curled. The instance and the session must outlive it.
class FingerTracking {
  public:
    FingerTracking() = default;  // sees nothing
    ~FingerTracking();
    FingerTracking(FingerTracking&& other) noexcept;
    FingerTracking& operator=(FingerTracking&& other) noexcept;

    // Sees nothing where the runtime cannot.
    static FingerTracking create(const HeadsetInstance& instance, XrSession session);
    void read(XrSpace base, XrTime time, std::array<HandReading, k_hand_count>& hands) const;

  private:
    void read_hand(std::size_t side, XrSpace base, XrTime time, HandReading& hand) const;

    PFN_xrLocateHandJointsEXT locate_ = nullptr;
    PFN_xrDestroyHandTrackerEXT destroy_ = nullptr;
    std::array<XrHandTrackerEXT, k_hand_count> trackers_{};
};

}  // namespace handhold
