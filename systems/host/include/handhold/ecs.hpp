#pragma once

// The world as packed columns and the frame that steps it: for hosts that read and write components
// directly. The component columns in `World` are the whole state; everything in `FrameCaches` may
// be rebuilt before any frame without changing the result.
//
//   World, add_body, add_joint, add_player, destroy    components/world.hpp
//   ShapeLibrary                                       collision shapes, shared by worlds
//   GripMeshLibrary                                    meshes that hands are fitted to
//   step_frame, hash_state                             one frame; a hash of the whole state
//   save_snapshot, restore_snapshot                    rollback and saved games
#include "components/play_space.hpp"
#include "components/world.hpp"
#include "engine/collision/shape_library.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "systems/frame.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/snapshot.hpp"
