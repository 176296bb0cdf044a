#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "engine/core/parallel.hpp"
#include "systems/frame/frame_stages.hpp"

namespace handhold::stages {

// Runs a stage in parallel on slices of `count` hands or players: stage(slice, first, last).
// `slice` is scratch memory that the stages use one after the other. Neither the slices nor the
// sums of their counters depend on the number of threads. Only fallbacks are summed: a stage in
// slices must not count anything else.
template <typename SliceStage>
void for_slices(const FrameContext& f, std::size_t count, const SliceStage& stage) {
    constexpr std::size_t k_elements_per_slice = 8;
    HandScratch& hands = f.hands();
    const std::size_t slices = (count + k_elements_per_slice - 1) / k_elements_per_slice;
    if (hands.slices.size() < slices) {
        hands.slices.resize(slices);
    }
    const auto run = [&](std::size_t slice, std::size_t first, std::size_t last) {
        hands.slices[slice].stats.clear();
        stage(hands.slices[slice], first, last);
    };
    parallel_slices(count, k_elements_per_slice, run);
    for (std::size_t slice = 0; slice < slices; ++slice) {
        std::ranges::transform(f.stats.fallbacks, hands.slices[slice].stats.fallbacks,
                               f.stats.fallbacks.begin(), std::plus<>());
    }
}

}  // namespace handhold::stages
