#pragma once

#include <optional>

#include "components/arm.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/size_estimate.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Greatest change of a measure, in the player's metres.
inline constexpr double k_size_mps = 0.035;
inline constexpr double k_size_m_per_frame = 0.9e-3;

struct EstimateSizesIo {
    double dt_s;                             // in: > 0
    const Column<PlayerOrigin>& origin;      // in: scale
    const Column<HeadTracking>& head;        // in
    const Column<HandOwner>& owner;          // in
    const Column<HandTracking>& hand;        // in
    const Column<Calibration>& calibration;  // in: done
    Column<SizeEstimate>& size;              // in/out
    Column<BodyMeasures>& measures;          // in/out; out: players who were not measured
};

// Estimates the size of players whom neither a T-pose nor the host measured, while they play. Eye
// height: a high percentile of the head's height above the tracked floor. Arms: a share of a high
// percentile of the hands' distance from the eyes, and at least nearly what is usual for that eye
// height, because not everybody stretches the arms. A player whose arms are far longer than usual
// for the eye height sits: the eye height is then the usual one for these arms. Only tracked
// devices count. The measures follow at k_size_mps, so no frame shows a jump.
void estimate_sizes(const EstimateSizesIo& io);

// Measures, in the player's metres, of all that was seen; nullopt: too little yet.
std::optional<BodyMeasures> seen_measures(const SizeEstimate& size);

}  // namespace handhold
