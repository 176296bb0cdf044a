#include "game/files/file_tools.hpp"

#include "systems/host/host_columns.hpp"

namespace handhold {

hh::Pose read_pose(const JsonValue& value, double limit_m) {
    if (!value.exists()) {
        return hh::k_origin;
    }
    value.allow_only({"position_m", "rotation_xyzw"});
    const NumberRange range = {-limit_m, limit_m, false};
    return to_host(Pose{value["position_m"].vector_or(Vec3::Zero(), range),
                        value["rotation_xyzw"].rotation_or(Quat::Identity())});
}

}  // namespace handhold
