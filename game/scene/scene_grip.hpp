#pragma once

#include <set>
#include <string>

#include "components/authored_grip.hpp"
#include "engine/io/json.hpp"

// Authored grips as files give them: one object of a body's "grips"
// (docs/reference/scene_format.md).
namespace handhold {

// In the frame of the body's shape (as `_bs` until the body is built: a hull's or a compound's
// centre of mass is elsewhere).
struct SceneGrip {
    std::string name;  // unique among the body's
    AuthoredGrip grip;
    int mirror_axis = k_no_mirror;  // 0 to 2: the left hand is the right one's mirror image across
                                    // the plane through the frame's origin with that normal
    static constexpr int k_no_mirror = -1;
};

// Wrists within 1e3 m, curls in [-30, 130] and oppositions in [-180, 180] degrees, priorities in
// [-100, 100], zones up to 1 m and 180 degrees. Refused, with JSON pointer and value: what is out
// of range, a grip for no hand, a mirror beside two hands, a finger or a key that is unknown, a
// name that is in `taken`.
SceneGrip read_scene_grip(const JsonValue& value, std::set<std::string>& taken);

// The grip as such an object; read_scene_grip gives the same again, but for rounding of angles.
std::string write_scene_grip(const SceneGrip& grip);

// The grip of a body whose shape stands at `frame` in the frame that the file gives it in.
AuthoredGrip in_body_frame(const AuthoredGrip& grip, const Pose& frame);

}  // namespace handhold
