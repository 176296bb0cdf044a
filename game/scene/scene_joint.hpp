#pragma once

#include <map>
#include <set>
#include <string>

#include "components/body.hpp"
#include "components/joint.hpp"
#include "engine/io/json.hpp"
#include "engine/math/math.hpp"

// A joint in a scene's JSON: docs/reference/scene_format.md, "Joints".
namespace handhold {

struct SceneJoint {
    std::string name;
    std::string a;  // name of a body; empty: the scene
    std::string b;  // name of a body
    // Joint that releases the latch: name of an earlier joint; empty: none.
    std::string handle;
    bool handle_is_angle = true;  // true: a hinge; false: a slider
    Pose pose;                    // joint's frame in the scene at time 0
    // Distance joints: the end on body a; other kinds: the frame's origin.
    Vec3 end_a = Vec3::Zero();
    Joint joint;  // kind and numbers; the builder sets entities and frames
};

// Kinds of the bodies and joints that were read so far, by name.
struct SceneJointNames {
    std::map<std::string, BodyKind> bodies;
    std::map<std::string, JointKind> joints;
};
SceneJoint read_scene_joint(const JsonValue& value, SceneJointNames& names);

}  // namespace handhold
