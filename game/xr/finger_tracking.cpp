#include "game/xr/finger_tracking.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "game/devices/headset_hands.hpp"
#include "game/xr/actions.hpp"

namespace handhold {

FingerTracking::~FingerTracking() {
    for (const XrHandTrackerEXT tracker : trackers_) {
        if (tracker != XR_NULL_HANDLE) {
            destroy_(tracker);
        }
    }
}

FingerTracking::FingerTracking(FingerTracking&& other) noexcept
    : locate_(other.locate_),
      destroy_(other.destroy_),
      trackers_(std::exchange(other.trackers_, {})) {}

FingerTracking& FingerTracking::operator=(FingerTracking&& other) noexcept {
    std::swap(locate_, other.locate_);
    std::swap(destroy_, other.destroy_);
    std::swap(trackers_, other.trackers_);
    return *this;
}

FingerTracking FingerTracking::create(const HeadsetInstance& instance, XrSession session) {
    FingerTracking made;
    if (!instance.features.hand_tracking) {
        return made;
    }
    const XrInstance xr = instance.instance.get();
    const auto create = xr_function<PFN_xrCreateHandTrackerEXT>(xr, "xrCreateHandTrackerEXT");
    made.destroy_ = xr_function<PFN_xrDestroyHandTrackerEXT>(xr, "xrDestroyHandTrackerEXT");
    made.locate_ = xr_function<PFN_xrLocateHandJointsEXT>(xr, "xrLocateHandJointsEXT");
    if (create == nullptr || made.destroy_ == nullptr || made.locate_ == nullptr) {
        return made;
    }
    for (std::size_t side = 0; side < 2; ++side) {
        auto info = xr_struct<XrHandTrackerCreateInfoEXT>(XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT);
        info.hand = side == HH_LEFT ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
        info.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
        if (XR_FAILED(create(session, &info, &made.trackers_[side]))) {
            made.trackers_[side] = XR_NULL_HANDLE;
        }
    }
    return made;
}

void FingerTracking::read(XrSpace base, XrTime time, std::array<HandReading, 2>& hands) const {
    for (std::size_t side = 0; side < 2; ++side) {
        hands[side].wrist_ps.reset();
        hands[side].guesses.wrist_ps.reset();
        hands[side].curls = k_curls_unknown;
        hands[side].curl = 0.0;
        if (trackers_[side] != XR_NULL_HANDLE) {
            read_hand(side, base, time, hands[side]);
        }
    }
}

void FingerTracking::read_hand(std::size_t side, XrSpace base, XrTime time,
                               HandReading& hand) const {
    std::array<XrHandJointLocationEXT, XR_HAND_JOINT_COUNT_EXT> joints{};
    auto info = xr_struct<XrHandJointsLocateInfoEXT>(XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT);
    info.baseSpace = base;
    info.time = time;
    auto found = xr_struct<XrHandJointLocationsEXT>(XR_TYPE_HAND_JOINT_LOCATIONS_EXT);
    found.jointCount = XR_HAND_JOINT_COUNT_EXT;
    found.jointLocations = joints.data();
    const XrHandJointLocationEXT& wrist = joints[XR_HAND_JOINT_WRIST_EXT];
    if (XR_FAILED(locate_(trackers_[side], &info, &found)) || found.isActive != XR_TRUE ||
        !is_valid_location(wrist.locationFlags)) {
        return;
    }
    if (is_inferred_location(wrist.locationFlags)) {  // and so are the fingers
        hand.guesses.wrist_ps = from_xr(wrist.pose);
        return;
    }
    hand.wrist_ps = from_xr(wrist.pose);
    // Some runtimes locate the wrist alone: the other joints are zeros then, and not valid.
    const auto place = [&](int joint) -> std::optional<hh::Vec3> {
        const XrHandJointLocationEXT& found_joint = joints[static_cast<std::size_t>(joint)];
        if ((found_joint.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0) {
            return std::nullopt;
        }
        return from_xr(found_joint.pose).position;
    };
    // The curl is the mean of those of middle, ring and little finger that are seen: index and
    // thumb may point while the hand is closed.
    constexpr std::array<std::array<int, 2>, 3> k_fingers = {{
        {XR_HAND_JOINT_MIDDLE_PROXIMAL_EXT, XR_HAND_JOINT_MIDDLE_TIP_EXT},
        {XR_HAND_JOINT_RING_PROXIMAL_EXT, XR_HAND_JOINT_RING_TIP_EXT},
        {XR_HAND_JOINT_LITTLE_PROXIMAL_EXT, XR_HAND_JOINT_LITTLE_TIP_EXT},
    }};
    int known = 0;
    double sum = 0.0;
    for (const auto& [knuckle, tip] : k_fingers) {
        const std::optional<hh::Vec3> knuckle_ps = place(knuckle);
        const std::optional<hh::Vec3> tip_ps = place(tip);
        const double curl = knuckle_ps && tip_ps
                                ? finger_curl(hand.wrist_ps->position, *knuckle_ps, *tip_ps)
                                : std::numeric_limits<double>::quiet_NaN();
        if (!std::isnan(curl)) {
            sum += curl;
            ++known;
        }
    }
    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> seen{};
    for (std::size_t joint = 0; joint < seen.size(); ++joint) {
        const auto joint_ps = place(static_cast<int>(joint));
        seen[joint].is_valid = joint_ps.has_value();
        seen[joint].pose.position = joint_ps.value_or(hh::Vec3{});
    }
    hh_finger_curls_of(seen.data(), &hand.curls);
    hand.curl = known > 0 ? sum / known : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace handhold
