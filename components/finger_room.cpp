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

std::uint32_t oppositions_of(const FingerRig& finger) {
    return finger.name == FingerName::thumb ? 3 : 1;
}

double opposition_rad(const FingerRig& finger, std::uint32_t place) {
    const std::uint32_t count = oppositions_of(finger);
    const double share = count > 1 ? place / (count - 1.0) : 0.0;
    return finger.lower_opposition_rad +
           share * (finger.upper_opposition_rad - finger.lower_opposition_rad);
}

ChainAngles bent(const Bend& bend, const ChainAngles& open_rad, const ChainAngles& closed_rad,
                 std::size_t link_count) {
    ChainAngles angle_rad = {};
    for (std::size_t i = 0; i < link_count; ++i) {
        angle_rad[i] =
            open_rad[i] + (i == 0 ? bend.first : bend.others) * (closed_rad[i] - open_rad[i]);
    }
    return angle_rad;
}

struct BestBend {
    double sunk_m = std::numeric_limits<double>::infinity();
    std::size_t bend = 0;  // of k_bends
    std::uint32_t opposition = 0;

    bool has_room() const { return sunk_m <= k_fingers_have_room_m; }
};

// Keeps the better; the first with room will do.
void try_bends(const HandSurroundings& hand, const HingeChain& chain, std::uint32_t opposition,
               ChainPatch& patch, BestBend& best) {
    // Straight, which is the first of the bends, most have room, and there is little to gather.
    patch.gather(chain_reach(chain, chain.open_rad, chain.open_rad), hand.meshes);
    const double straight_m = chain_depth(chain, chain.open_rad, patch).depth_m;
    if (straight_m < best.sunk_m) {
        best = {straight_m, 0, opposition};
    }
    if (best.has_room()) {
        return;
    }
    patch.gather(chain_reach(chain, chain.open_rad, highest(chain.open_rad, chain.closed_rad)),
                 hand.meshes);
    ChainDepths depths(chain, patch);
    for (std::size_t i = 1; i < k_bends.size() && !best.has_room(); ++i) {
        const double depth_m = depths.depth_m(
            bent(k_bends[i], chain.open_rad, chain.closed_rad, chain.link_count), best.sunk_m);
        if (depth_m < best.sunk_m) {
            best = {depth_m, i, opposition};
        }
    }
}

}  // namespace

FingerRoom find_finger_room(const HandSurroundings& hand, const Pose& wrist_bs, ChainPatch& patch) {
    FingerRoom room;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        BestBend best;
        for (std::uint32_t i = 0; i < oppositions_of(finger) && !best.has_room(); ++i) {
            try_bends(hand, finger_chain(finger, opposition_rad(finger, i), wrist_bs), i, patch,
                      best);
        }
        if (!best.has_room()) {
            room.bends[f] =
                static_cast<std::uint8_t>(1 + best.bend + k_bends.size() * best.opposition);
        }
        room.sunk_m = std::max(room.sunk_m, best.sunk_m);
    }
    return room;
}

std::optional<FingerAngles> bent_as(const FingerRig& finger, std::uint8_t bend) {
    if (bend == 0 || bend > k_bends.size() * oppositions_of(finger)) {
        return std::nullopt;
    }
    const std::size_t place = bend - std::size_t{1};
    FingerAngles angles;
    angles.curl_rad = bent(k_bends[place % k_bends.size()], finger.lower_rad, finger.upper_rad,
                           finger.link_count);
    angles.opposition_rad =
        opposition_rad(finger, static_cast<std::uint32_t>(place / k_bends.size()));
    return angles;
}

}  // namespace handhold
