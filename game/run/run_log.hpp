#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// The record of a run, from which frames.csv, bodies.csv, report.json and report.html are written.
namespace handhold {

struct HandLog {
    Vec3 target_ws = Vec3::Zero();  // palm of the tracked hand
    Vec3 shown_ws = Vec3::Zero();   // palm of the shown hand; on its anchor while gripping
    int grip = 0;                   // GripKind
    std::int32_t body = -1;         // index into RunLog::body_names; -1: none
    double error_m = 0.0;
};

struct PlayerLog {
    std::uint32_t player = 0;  // index into RunLog::player_names
    Vec3 origin_ws = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();  // velocity of the origin
    Vec3 head_ws = Vec3::Zero();
    std::array<HandLog, k_hand_count> hands;  // indexed by HandSide
    double push_back_m = 0.0;
};

// A kinematic or free body at the end of a frame.
struct BodyLog {
    std::uint32_t body = 0;  // index into RunLog::body_names
    Pose pose_ws;
    Vec3 velocity_mps = Vec3::Zero();
    Vec3 spin_radps = Vec3::Zero();
};

struct FrameLog {
    std::uint64_t frame = 0;  // first frame: 1
    double t_s = 0.0;         // end of the frame
    StageStats stats;
    std::vector<PlayerLog> players;
    std::vector<BodyLog> bodies;
};

struct RunLog {
    std::string scene;
    std::string input;  // file or built-in session; empty: none
    std::string spawn;  // name, or "auto: x y z, yaw"
    double hz = 90.0;
    int threads = 1;
    // Size of the player's and both hands' state in the world's columns.
    std::size_t bytes_per_player = 0;
    std::vector<std::string> player_names;
    std::vector<double> player_mass_kg;
    std::vector<std::string> body_names;
    std::vector<double> body_mass_kg;  // 0: not free
    std::vector<FrameLog> frames;      // all, or only the last (RunSettings::keep_frames)
    double wall_s = 0.0;               // stepping only, without logging and pictures
    std::uint64_t state_hash = 0;
};

}  // namespace handhold
