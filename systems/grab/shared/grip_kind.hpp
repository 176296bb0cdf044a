#pragma once

#include "components/body.hpp"
#include "components/grab.hpp"

namespace handhold {

// Kind of a grip on `body`: a light free body moves with the hand; any other body moves the player.
inline GripKind grip_kind_of(const RigidBody& body, double heavy_body_kg) {
    const bool is_light = body.kind == BodyKind::free && body.mass_kg < heavy_body_kg;
    return is_light ? GripKind::held : GripKind::surface;
}

}  // namespace handhold
