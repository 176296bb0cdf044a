#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <handhold/handhold.hpp>

// The record of a run, from which frames.csv, bodies.csv, report.json and report.html are written.
namespace handhold {

// Statistics of a frame, as hh_world_stats, hh_world_stage_times and hh_world_fallbacks give them.
struct RunStats {
    RunStats();  // all 0

    std::vector<double> stage_us;          // indexed as hh_stage_name
    std::vector<std::uint64_t> fallbacks;  // indexed as hh_fallback_name
    std::uint64_t grab_onsets = 0;
    std::uint64_t grabs_gripped = 0;
    std::uint64_t islands = 0;
    std::uint64_t islands_pushed = 0;
    std::uint64_t contacts = 0;
    std::uint64_t contact_rounds = 0;
    std::uint64_t newton_iterations = 0;
    double residual_m = 0.0;
    double joint_error_m = 0.0;
    double joint_error_rad = 0.0;
    hh_momentum momentum{};
};

struct HandLog {
    hh::Vec3 target_ws{};    // palm of the tracked hand
    hh::Vec3 shown_ws{};     // palm of the shown hand; on its anchor while gripping
    int grip = 0;            // hh_grip_kind
    std::int32_t body = -1;  // index into RunLog::body_names; -1: none
    double error_m = 0.0;
};

struct PlayerLog {
    std::uint32_t player = 0;  // index into RunLog::player_names
    hh::Vec3 origin_ws{};
    hh::Vec3 velocity_mps{};  // velocity of the origin
    hh::Vec3 head_ws{};
    std::array<HandLog, 2> hands;  // indexed by hh::Side
    double push_back_m = 0.0;
};

// A kinematic or free body at the end of a frame.
struct BodyLog {
    std::uint32_t body = 0;  // index into RunLog::body_names
    hh::Pose pose_ws = hh::k_origin;
    hh::Vec3 velocity_mps{};
    hh::Vec3 spin_radps{};
};

struct FrameLog {
    std::uint64_t frame = 0;  // first frame: 1
    double t_s = 0.0;         // end of the frame
    RunStats stats;
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
