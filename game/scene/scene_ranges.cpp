#include "game/scene/scene_ranges.hpp"

namespace handhold {

std::array<float, 3> read_color(const JsonValue& value, const NumberRange& range) {
    const Vec3 color = value.vector(range);
    return {static_cast<float>(color.x()), static_cast<float>(color.y()),
            static_cast<float>(color.z())};
}

}  // namespace handhold
