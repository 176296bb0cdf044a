#pragma once

// Hand and body rigs: the built-in ones, rigs fitted to glTF skeletons, and body clips.
#include "systems/rigs/body_clips.hpp"
#include "systems/rigs/body_clips_json.hpp"
#include "systems/rigs/body_rig.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_rig_fit.hpp"
