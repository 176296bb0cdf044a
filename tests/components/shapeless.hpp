#pragma once

#include <string_view>

#include "components/world.hpp"

// A body and a player without collision shapes.
namespace handhold::test {

inline BodyDescription shapeless_rock(std::string_view name) {
    BodyDescription description;
    description.name = name;
    description.body = {BodyKind::free, 2.0, Vec3(0.1, 0.1, 0.1), 0.3, 0.4};
    description.shape = k_no_shape;
    return description;
}

inline PlayerDescription shapeless_player(std::string_view name) {
    PlayerDescription description;
    description.name = name;
    description.head_shape = k_no_shape;
    return description;
}

}  // namespace handhold::test
