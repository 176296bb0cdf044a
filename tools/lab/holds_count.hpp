#pragma once

#include <cstddef>
#include <cstdint>

#include "components/world.hpp"

namespace handhold::lab {

// Counts grips in a world, tick by tick.
struct HoldsCount {
    std::uint64_t grips = 0;         // hands that closed on something
    std::uint64_t shared_holds = 0;  // ticks in which hands of two players hold one body

    void add(const World& world) {
        std::size_t holding = 0;
        bool is_shared = false;
        for (std::size_t a = 0; a < world.grab.size(); ++a) {
            const Grab& grab = world.grab.elements()[a];
            holding += grab.kind != GripKind::none ? 1U : 0U;
            for (std::size_t b = 0; b < a && grab.kind == GripKind::held; ++b) {
                const Grab& other = world.grab.elements()[b];
                is_shared = is_shared || (other.kind == GripKind::held && other.body == grab.body &&
                                          world.hand_owner.at(world.grab.owners()[a]).player !=
                                              world.hand_owner.at(world.grab.owners()[b]).player);
            }
        }
        grips += holding > holding_ ? holding - holding_ : 0;
        shared_holds += is_shared ? 1U : 0U;
        holding_ = holding;
    }

  private:
    std::size_t holding_ = 0;  // hands that held something in the last tick
};

}  // namespace handhold::lab
