#pragma once

#include <set>
#include <string>

#include "components/authored_grip.hpp"
#include "engine/io/json.hpp"

// Authored grips in files: objects in a body's "grips" (docs/reference/scene_format.md).
namespace handhold {

// In the frame of the body's shape (called `_bs` until the body is built, although the centre of
// mass of a hull or compound is elsewhere).
struct SceneGrip {
    std::string name;  // unique among the body's grips
    AuthoredGrip grip;
    int mirror_axis = k_no_mirror;  // 0 to 2: normal axis of the mirror plane through the frame's
                                    // origin; the left hand is the right hand's mirror image
    static constexpr int k_no_mirror = -1;
};

// Limits: wrists 1e3 m, curls [-30, 130] and oppositions [-180, 180] degrees, priorities [-100,
// 100], zones 1 m and 180 degrees. Refused, with JSON pointer and value: values out of range, a
// grip for no hand, a mirror beside two hands, unknown fingers and keys, a name in `taken`.
SceneGrip read_scene_grip(const JsonValue& value, std::set<std::string>& taken);

// The grip as such an object. read_scene_grip gives it back, except for the rounding of angles.
std::string write_scene_grip(const SceneGrip& grip);

// The grip in the body's frame. `frame` is the body's frame in the frame of the file.
AuthoredGrip in_body_frame(const AuthoredGrip& grip, const Pose& frame);

}  // namespace handhold
