#pragma once

#include "components/arm.hpp"
#include "components/render.hpp"
#include "components/spine.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PublishBodyIo {
    const Column<ArmPose>& arms;     // in
    const Column<SpinePose>& spine;  // in
    Column<RenderPose>& render;      // out: arms, spine
};

// Copies arms and spine to the render pose.
void publish_body(const PublishBodyIo& io);

}  // namespace handhold
