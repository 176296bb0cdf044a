#include "components/finger_room.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "components/finger_chain.hpp"
#include "engine/geometry/hinge_chain.hpp"

namespace handhold {
namespace {

// Shares of the way from open to closed: of the first hinge, and of the others. Straight first,
// since most fingers have room there.
struct Bend {
    double first;
    double others;
};
constexpr std::array<Bend, 8> k_bends = {{{0.0, 0.0},
                                          {0.25, 0.25},
                                          {0.0, 0.5},
                                          {0.5, 0.25},
                                          {0.5, 0.5},
                                          {0.25, 0.75},
                                          {0.75, 0.75},
                                          {0.75, 0.25}}};

// At the best of the bends, where that is less than `least_m`.
double least_sunk_m(const HandSurroundings& hand, const HingeChain& chain, double least_m,
                    ChainPatch& patch) {
    patch.gather(chain_reach(chain, chain.open_rad, highest(chain.open_rad, chain.closed_rad)),
                 hand.meshes);
    for (const Bend& bend : k_bends) {
        ChainAngles angle_rad = {};
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            angle_rad[i] = chain.open_rad[i] + (i == 0 ? bend.first : bend.others) *
                                                   (chain.closed_rad[i] - chain.open_rad[i]);
        }
        const ChainDepth depth = chain_depth(chain, angle_rad, patch, {.enough_m = least_m});
        least_m = std::min(least_m, depth.depth_m);
        if (least_m <= 0.0) {
            break;
        }
    }
    return least_m;
}

}  // namespace

double fingers_sunk_m(const HandSurroundings& hand, const Pose& wrist_bs, ChainPatch& patch) {
    double deepest_m = 0.0;
    for (const FingerRig& finger : hand.rig->fingers) {
        const int oppositions = finger.name == FingerName::thumb ? 3 : 1;
        double least_m = std::numeric_limits<double>::infinity();
        for (int i = 0; i < oppositions && least_m > 0.0; ++i) {
            const double share = oppositions > 1 ? i / (oppositions - 1.0) : 0.0;
            const double opposition_rad =
                finger.lower_opposition_rad +
                share * (finger.upper_opposition_rad - finger.lower_opposition_rad);
            least_m =
                least_sunk_m(hand, finger_chain(finger, opposition_rad, wrist_bs), least_m, patch);
        }
        deepest_m = std::max(deepest_m, least_m);
    }
    return deepest_m;
}

}  // namespace handhold
