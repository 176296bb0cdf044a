#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "game/climber/crowd.hpp"
#include "game/net/match_peer.hpp"
#include "game/scene/scene.hpp"
#include "game/session/playback.hpp"

// Players of a match without a person.
namespace handhold {

// A scripted climber, who sees the world as the peer shows it.
class ClimberHands {
  public:
    ClimberHands(Scene& scene, hh::Player player, std::uint64_t seed)
        : scene_(scene), player_(player), seed_(seed) {}

    void operator()(double end_s, PeerInput& input);

  private:
    std::reference_wrapper<Scene> scene_;
    hh::Player player_;
    std::uint64_t seed_;
    std::shared_ptr<Crowd> crowd_;  // made once the world is the server's
    double given_until_s_ = 0.0;    // the last sample's time
};

// A recorded session. It begins when the player does.
class RecordedHands {
  public:
    explicit RecordedHands(const Recording& recording)
        : playback_(std::make_shared<Playback>(recording)) {}

    void operator()(double end_s, PeerInput& input);

  private:
    std::shared_ptr<Playback> playback_;
    std::optional<double> begin_s_;  // time of the world's clock
    double asked_until_s_ = 0.0;
    double given_until_s_ = -1.0;
};

}  // namespace handhold
