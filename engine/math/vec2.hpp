#pragma once

#include "engine/math/math.hpp"

namespace handhold {

using Vec2 = Eigen::Vector2d;

}  // namespace handhold
