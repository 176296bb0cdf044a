#pragma once

#include <cstdint>

#include "systems/frame/frame.hpp"
#include "systems/grab/shared/grab_search.hpp"
#include "systems/physics/accept_solution.hpp"

// Each function runs one stage on a world's columns. frame.cpp alone decides their order.
namespace handhold::stages {

// The data that stages may need. Each function below passes its stage only the columns it uses.
struct FrameContext {
    World& w;
    FrameCaches& caches;
    const Tuning& tuning;
    const FrameInput& input;
    StageStats& stats;

    double dt_s() const { return input.dt_s; }
    double start_s() const { return w.clock.t_s; }
    double end_s() const { return w.clock.t_s + input.dt_s; }
    FrameGraph& graph() const { return caches.graph; }
    CollisionWorld& collision() const { return caches.collision; }
    SurfaceQuery surfaces() const {
        return caches.host_surfaces ? caches.host_surfaces : SurfaceQuery(caches.collision);
    }
    HandScratch& hands() const { return caches.hands; }
};

void read_tracking(const FrameContext& f);
void read_paused_tracking(const FrameContext& f);
void calibrate_players(const FrameContext& f);
// Its time counts as that of calibrate_players.
void estimate_sizes(const FrameContext& f);
void group_joints(const FrameContext& f);
void place_colliders(const FrameContext& f, Stage needed_by);
// Poses the bodies that hands may grip in this frame. `asking`: a hand that asks between frames;
// null: none. Its time is part of update_grabs.
void pose_grippable_bodies(const FrameContext& f, Entity asking);
GrabSearch grab_search(const FrameContext& f);
void update_grabs(const FrameContext& f);
// Updates only HandSight, for frames in which hands grip nothing by themselves.
void update_sights(const FrameContext& f);
void locomote_players(const FrameContext& f);
void pull_bodies(const FrameContext& f);
void animate_movers(const FrameContext& f);
void predict_bodies(const FrameContext& f);
void anchor_grabs(const FrameContext& f);
void find_contacts(const FrameContext& f);
// Removes the frame's contacts, because the host finds its own.
void clear_contacts(const FrameContext& f);
void build_constraints(const FrameContext& f);
void solve_phases(const FrameContext& f);
void finish_positions(const FrameContext& f);
void solve_velocities(const FrameContext& f);
void book_momentum(const FrameContext& f);
void record_valid_poses(const FrameContext& f);
void limit_velocities(const FrameContext& f);
void update_joints(const FrameContext& f);
// Takes the host's solution and writes StageStats::hand_error_m. Its time is not part of any
// stage's time.
void accept_solution(const FrameContext& f, std::span<const SolvedPlayer> solved);
// Leaves the frame without constraints and push-backs, because the host has moved everything.
void clear_solution(const FrameContext& f);
// Runs keep_holds. Its time is not part of any stage's time.
void keep_holds(const FrameContext& f);
void discard_broken_results(const FrameContext& f);
void gather_surroundings(const FrameContext& f);
void search_grip(const FrameContext& f);
void constrain_palms(const FrameContext& f);
void sweep_fingers(const FrameContext& f);
void fit_hands(const FrameContext& f);
void estimate_arms(const FrameContext& f);
void layer_clavicles(const FrameContext& f);
void pose_arms(const FrameContext& f);
void propagate_spine(const FrameContext& f);
void layer_additives(const FrameContext& f);
// Its time counts as that of layer_additives.
void limit_pelvis(const FrameContext& f);
void limit_feet(const FrameContext& f);
void clear_arms(const FrameContext& f);
void publish_pose(const FrameContext& f);
void publish_body(const FrameContext& f);

// The parts of a frame, in order: frame.cpp lists their stages.
void read_input(const FrameContext& f);
enum class Contacts : std::uint8_t { searched, from_host };
void prepare_solve(const FrameContext& f, Contacts contacts);
void solve(const FrameContext& f);
void finish_solve(const FrameContext& f);
void show(const FrameContext& f);
// Checks the input and clears the statistics. Throws PreconditionError for invalid input.
FrameContext begin_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                         const FrameInput& input, StageStats& stats);
void advance_clock(const FrameContext& f);

}  // namespace handhold::stages
