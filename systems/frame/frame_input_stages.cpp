// Stages that read the devices and what they say of the players.
#include "systems/body/calibrate_players.hpp"
#include "systems/body/estimate_sizes.hpp"
#include "systems/frame/frame_slices.hpp"
#include "systems/frame/frame_stage_timer.hpp"
#include "systems/frame/frame_stages.hpp"
#include "systems/input/read_paused_tracking.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold::stages {

void read_tracking(const FrameContext& f) {
    const StageTimer timer(Stage::read_tracking, f.stats);
    World& w = f.w;
    const ReadTrackingIo io{.inputs = f.input.players,
                            .frame_start_s = f.start_s(),
                            .frame_end_s = f.end_s(),
                            .origin = w.player_origin,
                            .owner = w.hand_owner,
                            .controller_to_hand = w.controller_to_hand,
                            .recenter_guess = w.recenter_guess,
                            .grab = w.grab,
                            .head = w.head_tracking,
                            .hand = w.hand_tracking,
                            .history = w.hand_history,
                            .commands = w.player_commands};
    for_slices(f, w.head_tracking.size(),
               [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
                   handhold::read_tracking(io, first, last, f.tuning, slice.stats);
               });
}

void read_paused_tracking(const FrameContext& f) {
    const StageTimer timer(Stage::read_tracking, f.stats);
    World& w = f.w;
    handhold::read_paused_tracking(
        {.inputs = f.input.players,
         .origin = w.player_origin,
         .owner = w.hand_owner,
         .controller_to_hand = w.controller_to_hand,
         .head = w.head_tracking,
         .hand = w.hand_tracking,
         .history = w.hand_history,
         .hand_in_controller = {default_controller_to_hand(HandSide::left, f.tuning.hand),
                                default_controller_to_hand(HandSide::right, f.tuning.hand)}});
}

void calibrate_players(const FrameContext& f) {
    const StageTimer timer(Stage::calibrate_players, f.stats);
    World& w = f.w;
    handhold::calibrate_players({.dt_s = f.dt_s(),
                                 .commands = w.player_commands,
                                 .origin = w.player_origin,
                                 .head = w.head_tracking,
                                 .owner = w.hand_owner,
                                 .hand = w.hand_tracking,
                                 .calibration = w.calibration,
                                 .measures = w.body_measures},
                                f.tuning.calibration);
}

void estimate_sizes(const FrameContext& f) {
    const StageTimer timer(Stage::calibrate_players, f.stats);
    World& w = f.w;
    handhold::estimate_sizes({.dt_s = f.dt_s(),
                              .origin = w.player_origin,
                              .head = w.head_tracking,
                              .owner = w.hand_owner,
                              .hand = w.hand_tracking,
                              .calibration = w.calibration,
                              .size = w.size_estimate,
                              .measures = w.body_measures});
}

}  // namespace handhold::stages
