#pragma once

#include <array>
#include <vector>

#include "game/scene/random.hpp"
#include "systems/host/host_columns.hpp"

namespace handhold {

// A hostile player: poses that jump and vanish, numbers that are not finite, samples out of order
// and with impossible times, random buttons and sticks. Seeded.
class HostilePlayer {
  public:
    // far_jump_m: how far devices jump rarely; 0: at most a metre or two.
    HostilePlayer(std::uint64_t seed, double far_jump_m);

    // Input of the frame from start_s to end_s. The samples stay valid until the next call.
    hh_player_input play(hh::Player player, double start_s, double end_s);

  private:
    struct Device {
        Pose at;
        Vec3 to = Vec3::Zero();
        bool lost = false;
        bool grab = false;
    };
    void move(Device& device, double reach_m, double dt_s);
    Pose shown(const Device& device);
    double broken_number();

    Random random_;
    double far_jump_m_;
    Device head_;
    std::array<Device, 2> hands_;
    std::vector<hh::Sample> samples_;
};

}  // namespace handhold
