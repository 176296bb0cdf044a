#include "systems/body/shared/rest_spine.hpp"

#include <cmath>

#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/spine_chain.hpp"

namespace handhold {
namespace {

// Angle of a link at rest, measured like the angle that its joint limit bounds.
double rest_angle(const SpineLink& link) {
    return link.kind == SpineLinkKind::shin ? arc_tangent2(link.rest.z(), -link.rest.y()) : 0.0;
}

}  // namespace

TrunkLean lean_at(const Quat& chest_ps, const Vec3& pull_ps, double lying) {
    const Quat to_chest = chest_ps.conjugate();
    return lean_of(to_chest * pull_ps, upright_turn(to_chest * Vec3::UnitY(), lying));
}

void rest_spine(const Quat& chest, double lying, double scale, double t_s, SpineMemory& memory) {
    const TrunkLean lean = lean_at(chest, Vec3::Zero(), lying);
    SpineChain chain{frame_at(leaning_chest(chest, lean)), {}};
    memory.velocity_mps.fill(Vec3::Zero());
    memory.twist_rad.fill(0.0);
    memory.moved_m = Vec3::Zero();
    memory.since_tick_s = std::fmod(t_s, k_spine_tick_s);
    memory.tick_chest_ps = chest;
    memory.contacts = {};
    memory.pull.now = Vec3::Zero();
    memory.pull.before = Vec3::Zero();
    memory.pull.rate_per_s = Vec3::Zero();
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& above = frame_above_link(chain, link);
        const Vec3& rest = i < k_spine_links ? lean.rest_above[i] : link.rest;
        memory.offset_m[i] = link_base(above, memory.offset_m, link, scale) +
                             above.axes * ((scale * link.length_m) * rest);
        memory.angle_rad[i] = i < k_spine_links
                                  ? arc_tangent2(rest.cross(link.rest).norm(), rest.dot(link.rest))
                                  : rest_angle(link);
        chain.links[i] = frame_at(link_frame(above.rotation, rest, 0.0));
    }
    memory.before_m = memory.offset_m;
    memory.pelvis = {};
    memory.feet = {};
}

}  // namespace handhold
