#include "systems/frame/frame_check.hpp"

#include <cmath>

#include "components/tuning_check.hpp"
#include "engine/core/check.hpp"

namespace handhold {
namespace {}  // namespace

void check_frame(const World& world, const FrameCaches& caches, const Tuning& tuning,
                 const FrameInput& input) {
    HH_CHECK(input.dt_s >= k_min_dt_s && input.dt_s <= k_max_dt_s,
             "dt_s must lie between 1e-6 and 10", input.dt_s);
    for (const double axis_mps : world.reference_velocity_mps) {
        HH_CHECK(std::abs(axis_mps) <= world_limits::k_max_speed_mps,
                 "reference_velocity_mps is out of range", axis_mps);
    }
    for (const double axis_mps2 : world.gravity_mps2) {
        HH_CHECK(std::abs(axis_mps2) <= world_limits::k_max_gravity_mps2,
                 "gravity_mps2 is out of range", axis_mps2);
    }
    check_tuning(tuning);
    for (std::size_t index = 0; index < world.collider.size(); ++index) {
        const ShapeId shape = world.collider.elements()[index].shape;
        if (shape == k_no_shape) {
            continue;
        }
        HH_CHECK(caches.shapes->has(shape), "no shape with this id", shape.index);
        if (caches.shapes->at(shape).kind == ShapeKind::mesh) {
            const RigidBody* const body = world.body.find(world.collider.owners()[index]);
            HH_CHECK(body != nullptr && body->kind != BodyKind::free, "a mesh cannot be free",
                     shape.index);
        }
    }
}

}  // namespace handhold
