#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "game/session/recording.hpp"

// What the players of `handhold-lab match` do with their devices.
namespace handhold::lab {

std::vector<std::string_view> match_scene_names();

// A match's scene and players.
//
// "crawl": players crawl over a floor with loose rocks, gripping and letting go all the time.
// "bars": the players of each pair pull one loose bar with a hand each, and wave the other.
// "together": each pair has a PairTask; the left hands throw a ball once.
// "recorded": recorded people in the scene of "crawl", with rocks where they press grab buttons.
struct MatchSetting {
    std::string scene = "crawl";
    std::size_t players = 8;
    std::size_t first_pair = 0;         // "together": pair k has the task of k + first_pair
    std::vector<Recording> recordings;  // "recorded": player i plays number i modulo their count
};

enum class PairTask : std::uint8_t {
    pull_bar,         // the task of "bars"
    swing_door,       // both hold a hinged board
    hand_over,        // one holds a tool, the other grips it, the first lets go; and back
    hold_each_other,  // each right hand grips the other's left arm
};
constexpr std::size_t k_pair_tasks = 4;
PairTask task_of_pair(const MatchSetting& setting, std::size_t pair);

// Places of bodies that hands of scripts rest on, in the space of the pair. Its players stand
// k_from_pair_m from it on both sides, along z.
constexpr double k_pair_height_m = 1.2;
constexpr double k_from_pair_m = 0.9;
constexpr double k_pair_half_m = 0.03;  // half of a bar's, board's or tool's thickness
constexpr double k_board_half_m = 0.4;  // a hinged board: from the hinge to the hands
// Players who hold each other stand so far from the pair's place, face to face.
constexpr double k_face_to_face_m = 0.45;
constexpr double k_ball_radius_m = 0.04;
// Centre of the ball in a player's left hand at the start, in play space.
Vec3 ball_ps(std::size_t player);
// Centres of the rocks, of radius k_grip_rock_m, that a recorded person grips; in play space.
constexpr double k_grip_rock_m = 0.05;
std::vector<Vec3> grip_rocks_ps(const Recording& recording);

// The devices of one player. Scripted hands tremble by 0.3 mm, as people's do, and are read 97
// times a second. A recorded person's are read when they were recorded. At the end of a recording
// the devices return to its start in k_return_s, with open hands.
class MatchHands {
  public:
    static constexpr double k_return_s = 1.0;

    MatchHands(const MatchSetting& setting, std::size_t player);
    // The devices at the next time at which they are read.
    TrackingSample next();

  private:
    TrackingSample next_recorded();

    std::string scene_;
    PairTask task_ = PairTask::pull_bar;
    std::size_t player_;
    std::vector<TrackingSample> recorded_;  // times from 0
    std::size_t count_ = 0;                 // samples that were read, in this round if recorded
    double round_s_ = 0.0;                  // start of this round of the recording
};

}  // namespace handhold::lab
