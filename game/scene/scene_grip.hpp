#pragma once

#include <set>
#include <string>

#include "components/authored_grip.hpp"
#include "engine/io/json.hpp"

// Authored grips in files: objects in a body's "grips" (docs/reference/scene_format.md).
namespace handhold {

// An authored grip in a file. Poses are in the frame of the body's shape, although their names end
// in `_bs`; in_body_frame converts them. For a hull or compound the two frames differ.
struct SceneGrip {
    std::string name;  // unique among the body's grips
    AuthoredGrip grip;
    // The hands are mirror images of each other in the plane through the frame's origin with this
    // normal: 0 x, 1 y, 2 z. k_no_mirror: the hands are independent.
    int mirror_axis = k_no_mirror;
    static constexpr int k_no_mirror = -1;
};

// Limits: wrists 1e3 m, curls [-30, 130] and oppositions [-180, 180] degrees, priorities [-100,
// 100], zones 1 m and 180 degrees. Errors are: values out of range, a grip without a hand, a mirror
// although both hands are given, unknown fingers and keys, a name in `taken`. Each names the JSON
// pointer and the value.
SceneGrip read_scene_grip(const JsonValue& value, std::set<std::string>& taken);

// The grip as a JSON object. read_scene_grip reads the same grip back, except for the rounding of
// angles.
std::string write_scene_grip(const SceneGrip& grip);

// Converts a grip from the file's frame to the body's frame. `frame`: the body's frame in the
// file's frame.
AuthoredGrip in_body_frame(const AuthoredGrip& grip, const Pose& frame);

}  // namespace handhold
