#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "game/net/net_messages.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

inline constexpr double k_match_tick_s = 1.0 / 90.0;

// A scene with a match's players in it, the same on every machine.
struct MatchScene {
    Scene scene;
    std::vector<hh::Player> players;  // indexed by slot
    MatchDigests digests{};           // taken before the first tick
};

// Adds `count` players, at the scene's first spawn and around it. Scripted climbers need jets, so a
// scene without gets weak ones. Error: there is no space for so many.
Result<MatchScene> make_match_scene(Scene scene, std::size_t count, std::uint64_t seed);

}  // namespace handhold
