#pragma once

#include <array>
#include <cstddef>

namespace handhold {

// Time for which a length had which value. Lengths are in the player's metres.
template <std::size_t Bins>
struct LengthHistogram {
    static constexpr double k_bin_m = 0.025;
    // Element i is the time for which the length was in [i, i + 1) * k_bin_m.
    std::array<double, Bins> time_s{};
};

// What was seen of a player's size while playing. Written by estimate_sizes.
struct SizeEstimate {
    // True: the player was measured by a T-pose, or by the host. BodyMeasures then stay as they
    // are.
    bool is_measured = false;
    LengthHistogram<104> eyes = {};  // height of the eyes above the tracked floor
    LengthHistogram<48> reach = {};  // distance of the hands from the eyes
};

}  // namespace handhold
