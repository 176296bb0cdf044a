#include "systems/body/publish_body.hpp"

#include "engine/ecs/join.hpp"

namespace handhold {

void publish_body(const PublishBodyIo& io) {
    join(
        io.render,
        [](Entity, RenderPose& out, const ArmPose& arms, const SpinePose& spine) {
            out.arms = arms;
            out.spine = spine;
        },
        io.arms, io.spine);
}

}  // namespace handhold
