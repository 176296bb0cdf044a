#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A bay with a rail and two players (game/assets/together.json). The caller must add its grip
// meshes (add_grip_meshes).
Scene make_together_scene();

// The session of the first player, who holds the rail with the left hand. The right hand grips the
// partner's forearm, moves her about, releases her, and then holds her by the thigh.
SessionScript together_script();

// The session of the second player. She floats, waves the arm that is held, and holds nothing.
SessionScript together_partner_script();

}  // namespace handhold
