#pragma once

#include <algorithm>
#include <cmath>

#include "components/stats.hpp"
#include "components/tracking.hpp"

// What head and hands share: from the samples of a frame to the pose at its end.
namespace handhold {

// True if the sample is later than the end of the frame; false for a time of NaN.
inline bool is_later(double t_s, double end_s) { return std::isfinite(t_s) && t_s > end_s; }

// Finds state and pose at the end of the frame, for the head and for hands alike. `later` is the
// first pose after the frame's end, or null. Returns true if no later pose is usable, so that an
// older one is held.
template <typename Device>
bool finish_device(Device& device, bool has_sample, const Pose* later, double later_t_s,
                   double end_s, double lost_after_s, StageStats& stats) {
    if (!has_sample && later == nullptr) {
        return false;  // never tracked
    }
    const bool first = device.state == TrackingState::never;
    if (has_sample && later != nullptr && later_t_s - device.sample_t_s > lost_after_s) {
        later = nullptr;  // the motion across a gap that long is unknown
    }
    if (!has_sample) {
        // The first frame has only a sample after its end. That sample's buttons count in its own
        // frame.
        device.sample_ps = *later;
        device.sample_t_s = end_s;
    }
    if (later == nullptr && end_s - device.sample_t_s > lost_after_s) {
        if (device.state != TrackingState::lost) {
            stats.count(Fallback::tracking_lost);
        }
        device.state = TrackingState::lost;
        return true;
    }
    device.state = TrackingState::tracked;
    device.pose_ps = device.sample_ps;
    if (later != nullptr && later_t_s > device.sample_t_s && end_s > device.sample_t_s) {
        const double t = (end_s - device.sample_t_s) / (later_t_s - device.sample_t_s);
        device.pose_ps = interpolate(device.sample_ps, *later, std::clamp(t, 0.0, 1.0));
    }
    if (first) {
        device.start_ps = device.pose_ps;
    }
    return later == nullptr;
}

}  // namespace handhold
