#pragma once

#include "components/body.hpp"
#include "components/grab.hpp"

namespace handhold {

// Kind of a grip on `body`: a light free body moves with the hand; any other body moves the player.
inline GripKind grip_kind_of(const RigidBody& body, double heavy_body_kg) {
    return is_light(body, heavy_body_kg) ? GripKind::held : GripKind::surface;
}

}  // namespace handhold
