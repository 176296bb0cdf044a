#include "systems/physics/group_joints.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/disjoint_sets.hpp"

namespace handhold {
void group_joints(const GroupJointsIo& io, const PhaseTuning& tuning) {
    JointGroups& groups = io.frame.joint_groups;
    groups.of_body.clear();
    groups.anchored.clear();
    if (io.joint.empty()) {
        return;
    }
    groups.of_body.resize(io.body.size());
    groups.anchored.assign(io.body.size(), 0);
    std::iota(groups.of_body.begin(), groups.of_body.end(), 0U);
    const auto light_index = [&](Entity entity) {
        const std::size_t index = io.body.find_index(entity);
        return index != Column<RigidBody>::k_npos &&
                       is_light(io.body.elements()[index], tuning.heavy_body_kg)
                   ? index
                   : Column<RigidBody>::k_npos;
    };
    for (const Joint& joint : io.joint.elements()) {
        const std::size_t a = light_index(joint.a);
        const std::size_t b = light_index(joint.b);
        if (a != Column<RigidBody>::k_npos && b != Column<RigidBody>::k_npos) {
            const std::uint32_t root_a = find_root(groups.of_body, static_cast<std::uint32_t>(a));
            const std::uint32_t root_b = find_root(groups.of_body, static_cast<std::uint32_t>(b));
            groups.of_body[std::max(root_a, root_b)] = std::min(root_a, root_b);
        }
    }
    for (std::uint32_t index = 0; index < groups.of_body.size(); ++index) {
        groups.of_body[index] = find_root(groups.of_body, index);
    }
    for (const Joint& joint : io.joint.elements()) {
        const std::size_t a = light_index(joint.a);
        const std::size_t b = light_index(joint.b);
        const bool may_be_slack = joint.kind == JointKind::distance && joint.lower < joint.upper;
        if (!may_be_slack && (a == Column<RigidBody>::k_npos) != (b == Column<RigidBody>::k_npos)) {
            groups.anchored[groups.of_body[std::min(a, b)]] = 1;  // k_npos is larger than any index
        }
    }
}

}  // namespace handhold
