#include "systems/grab/shared/grab_rules.hpp"

namespace handhold {

const GrabRule* GrabRules::rule_of(Entity body) const { return rule.find(body); }

bool GrabRules::allow(const HandOwner& hand, Entity body) const {
    const GrabRule* const of_body = rule_of(body);
    if (of_body != nullptr && !(hand.side == HandSide::left ? of_body->left : of_body->right)) {
        return false;
    }
    const GrabLayers* const wanted = layers.find(hand.player);
    if (wanted == nullptr) {
        return true;
    }
    const CollisionFilter* const found = filter.find(body);
    return (wanted->layers & (found != nullptr ? *found : CollisionFilter{}).layers) != 0;
}

}  // namespace handhold
