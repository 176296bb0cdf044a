#include "systems/hand/shared/finger_clearance.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/geometry/hinge_chain.hpp"
#include "systems/hand/shared/finger_chain.hpp"

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

// No bend turns a hinge farther.
ChainAngles most_bent(const HingeChain& chain) {
    constexpr Bend k_most = [] {
        Bend most = {0.0, 0.0};
        for (const Bend& bend : k_bends) {
            most = {std::max(most.first, bend.first), std::max(most.others, bend.others)};
        }
        return most;
    }();
    return bent(k_most, chain.open_rad, chain.closed_rad, chain.link_count);
}

struct BestBend {
    double sunk_m = std::numeric_limits<double>::infinity();
    std::size_t bend = 0;  // of k_bends
    std::uint32_t opposition = 0;

    bool has_room() const { return sunk_m <= k_fingers_have_room_m; }
};

// Straight, as most have room, and there is little to gather.
void try_straight(const HandSurroundings& hand, const HingeChain& chain, std::uint32_t opposition,
                  ChainPatch& patch, BestBend& best) {
    const double straight_m = posed_depth_m(chain, chain.open_rad, hand.meshes, patch);
    if (straight_m < best.sunk_m) {
        best = {straight_m, 0, opposition};
    }
}

// The other bends, at the opposition of the best; the first with room will do.
void try_bends(const HandSurroundings& hand, const HingeChain& chain, ChainPatch& patch,
               BestBend& best) {
    patch.gather(chain_reach(chain, chain.open_rad, highest(chain.open_rad, most_bent(chain))),
                 hand.meshes);
    ChainDepths depths(chain, patch);
    for (std::size_t i = 1; i < k_bends.size() && !best.has_room(); ++i) {
        const double depth_m = depths.depth_m(
            bent(k_bends[i], chain.open_rad, chain.closed_rad, chain.link_count), best.sunk_m);
        if (depth_m < best.sunk_m) {
            best = {depth_m, i, best.opposition};
        }
    }
}

}  // namespace

FingerRoom find_finger_room(const HandSurroundings& hand, const Pose& wrist_bs, ChainPatch& patch) {
    FingerRoom room;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        const auto chain_at = [&](std::uint32_t opposition) {
            return finger_chain(finger, opposition_rad(finger, opposition), wrist_bs);
        };
        BestBend best;
        for (std::uint32_t i = 0; i < oppositions_of(finger) && !best.has_room(); ++i) {
            try_straight(hand, chain_at(i), i, patch, best);
        }
        if (!best.has_room()) {
            try_bends(hand, chain_at(best.opposition), patch, best);
        }
        if (!best.has_room()) {
            room.bends[f] =
                static_cast<std::uint8_t>(1 + best.bend + k_bends.size() * best.opposition);
        }
        room.sunk_m = std::max(room.sunk_m, best.sunk_m);
    }
    return room;
}

double bent_depth_m(const HandSurroundings& hand, const FingerBends& bends, const Pose& wrist_bs,
                    ChainPatch& patch) {
    double depth_m = 0.0;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        const auto angles = bent_as(finger, bends[f]);
        if (angles) {
            const HingeChain chain = finger_chain(finger, angles->opposition_rad, wrist_bs);
            depth_m = std::max(depth_m, posed_depth_m(chain, angles->curl_rad, hand.meshes, patch));
        }
    }
    return depth_m;
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
