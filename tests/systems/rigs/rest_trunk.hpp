#pragma once

#include "components/render.hpp"
#include "systems/rigs/body_rig.hpp"

namespace handhold::test {

// Spine, head and clavicles of a figure as in its file.
inline RenderPose rest_trunk(const BodyRig& rig) {
    RenderPose render;
    for (const BodyRig::Carrier& carrier : rig.carriers) {
        if (carrier.bone == BodyBone::clavicle) {
            render.arms.arms[index_of(carrier.side)].clavicle_ws = carrier.rest_ms;
        }
    }
    const Pose chest = rig.carriers[BodyRig::k_chest].rest_ms;
    const double trunk_m = rig.carriers[BodyRig::k_chest].length_m;
    const auto at = [&](double along) {
        return Pose{chest.position - (1.0 - along) * trunk_m * (chest.rotation * Vec3::UnitY()),
                    chest.rotation};
    };
    render.spine.chest_ws = chest;
    render.spine.pelvis_ws = at(0.0);
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        render.spine.spine_ws[i] =
            at(1.0 - static_cast<double>(i) / static_cast<double>(k_spine_links));
    }
    render.head_ws = rig.carriers[BodyRig::k_head].rest_ms;
    return render;
}

}  // namespace handhold::test
