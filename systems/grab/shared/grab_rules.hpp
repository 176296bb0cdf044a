#pragma once

#include "components/body.hpp"
#include "components/grab.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Rules that restrict which hand may grip which body. Empty columns restrict nothing.
struct GrabRules {
    const Column<GrabRule>& rule;           // rules of bodies
    const Column<GrabLayers>& layers;       // layers of players
    const Column<CollisionFilter>& filter;  // layers of bodies; without an element: the default

    // The body's rule; null if it has none.
    const GrabRule* rule_of(Entity body) const;
    // False if the body's rule or the layers of the hand's player refuse the hand.
    bool allow(const HandOwner& hand, Entity body) const;
};

}  // namespace handhold
