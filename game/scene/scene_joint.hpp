#pragma once

#include <map>
#include <set>
#include <string>

#include "components/body.hpp"
#include "components/joint.hpp"
#include "engine/io/json.hpp"
#include "engine/math/math.hpp"

// A joint as a scene's JSON says it: docs/reference/scene_format.md, "Joints".
namespace handhold {

struct SceneJoint {
    std::string name;
    std::string a;                // a body's name; empty: the scene itself
    std::string b;                // a body's name
    std::string handle;           // of the latch: the name of an earlier joint; empty: none
    bool handle_is_angle = true;  // a hinge, not a slider
    Pose pose;                    // the joint's frame in the scene as everything stands at time 0
    Vec3 end_a = Vec3::Zero();    // distance: its end on a; else as the frame
    Joint joint;  // kind and numbers; its entities and frames are for whoever builds it
};

// Bodies of the scene so far by name, and the kinds of its joints so far.
struct SceneJointNames {
    std::map<std::string, BodyKind> bodies;
    std::map<std::string, JointKind> joints;
};
SceneJoint read_scene_joint(const JsonValue& value, SceneJointNames& names);

}  // namespace handhold
