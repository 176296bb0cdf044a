#pragma once

// For source embedders: the world as packed columns and the stages that step it. Types are Eigen's,
// errors are exceptions, and nothing here is stable between versions; handhold.h is.
//
//   World, add_body, add_joint, add_player, destroy    components/world.hpp
//   move_kinematic, teleport_body, teleport_player     components/world_edit.hpp
//   ShapeLibrary                                       collision shapes, for any number of worlds
//   GripMeshLibrary                                    meshes that hands are fitted to
//   step_frame, step_pose_only, hash_state             one frame; a hash of the whole state
//   step_simulated, hash_simulated, SimulatedState     rollback within a window of frames
//   begin_host_frame, end_host_frame                   frames around a host's own solver
//   save_snapshot, restore_snapshot                    rollback and saved games
//   columns_of                                         from a hh_world of handhold.h to all of this
//   rigs.hpp, tuning.hpp, files.hpp                    assets and numbers
//
// The rule of state: the columns of `World` are the whole state. Everything in `FrameCaches` may be
// dropped and rebuilt before any frame without changing a bit of the result. Between frames a host
// may read every column, and write those whose comment names the host as their writer.
#include <handhold/files.hpp>
#include <handhold/rigs.hpp>
#include <handhold/tuning.hpp>
#include <handhold/version.hpp>

#include "components/play_space.hpp"
#include "components/world.hpp"
#include "components/world_edit.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/shape_library.hpp"
#include "systems/frame/frame_of_host.hpp"
#include "systems/host/host_columns.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/snapshot/simulated_state.hpp"
#include "systems/snapshot/snapshot.hpp"
