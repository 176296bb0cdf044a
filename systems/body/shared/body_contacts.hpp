#pragma once

#include "components/spine.hpp"
#include "engine/collision/surface_query.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/fold_body.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/spine_chain.hpp"

// Finds surfaces at the shown trunk and legs, and keeps those in front of the surfaces. The body
// applies no force to the surfaces.
namespace handhold {

// Inputs of find_body_contacts for one player.
struct BodySurroundings {
    SurfaceQuery surfaces;
    std::uint64_t own_id = 0;  // id of the player, whose head is ignored
    Pose origin_ws;
    Vec3 head_ps = Vec3::Zero();  // a point well inside the head's collider
    Vec3 chest_ps = Vec3::Zero();
    Vec3 free_ps = -Vec3::UnitY();  // free_body
    TrackedFloor floor;
    double origin_scale = 1.0;  // PlayerOrigin::scale
    // The body as it was shown in the last frame, with clips: surfaces are searched at the parts
    // where they are seen.
    const SpinePose& shown;
};

inline constexpr double k_body_searches_per_s = 15.0;
inline constexpr double k_part_moved_m = 0.005;  // length in the player's metres

// Length of trunk and thighs, for an eye height of k_scale_eye_m.
inline constexpr double k_free_body_m =
    k_spine_link_m[0] + k_spine_link_m[1] + k_spine_link_m[2] + k_thigh_m;

// Updates SpineMemory::contacts for one frame that ends at t_s. Each part is searched at most
// k_body_searches_per_s times a second of the world's clock: a sphere is cast along it, from the
// part's end that is nearer to the head. The last result is reused while no surface near the part
// has moved and both ends have moved by less than k_part_moved_m. It is never reused if
// SurfaceQuery::hash_near returns nullopt. In frames between searches the plane moves with the
// reference velocity. `moved_m`: displacement of the chest in this frame relative to that motion.
void find_body_contacts(const BodySurroundings& around, double t_s, double dt_s,
                        const Vec3& moved_m, SpineMemory& memory);

// The contact of the body part to which a link belongs; null if it touches nothing.
const BodyContact* contact_of(const SpineMemory& memory, std::size_t link);

// A link that before_surface turns.
struct TouchingLink {
    Vec3 towards;  // unit, in the parent's frame
    Vec3 base_m;   // upper end, relative to the chest
    double length_m = 0.0;
    double scale = 1.0;  // PlayerOrigin::scale
};

// Turns a link's direction, in its parent's frame, until the link's lower end is in front of the
// surface. The speed of the lower end is limited, so that a link that starts inside a wall moves
// out without a jump.
Vec3 before_surface(const TouchingLink& link, const SpineFrame& above, const BodyContact& contact);

// Returns the velocity of a joint that touches a surface, after correction_mps was added to it. Its
// normal part is limited so that the joint neither moves into the surface nor leaves it faster than
// before. Then all of it is reduced, because surfaces are rough.
Vec3 touching_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps);

}  // namespace handhold
