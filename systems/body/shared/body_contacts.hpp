#pragma once

#include "components/spine.hpp"
#include "engine/collision/surface_query.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/spine_chain.hpp"

// Surfaces that the shown trunk and legs keep in front of. They apply no force to them.
namespace handhold {

// What the search for surfaces knows of a player.
struct BodySurroundings {
    SurfaceQuery surfaces;
    std::uint64_t own_id = 0;  // id of the player, whose head is ignored
    Pose origin_ws;
    Vec3 head_ps = Vec3::Zero();  // a point well inside the head's collider
    Vec3 chest_ps = Vec3::Zero();
    TrackedFloor floor;
    // The body as it was shown in the last frame: parts are searched where they are seen, with
    // clips.
    const SpinePose& shown;
};

inline constexpr double k_body_searches_per_s = 15.0;
inline constexpr double k_part_moved_m = 0.005;

// Updates SpineMemory::contacts for one frame that ends at t_s. Each part is searched at most
// k_body_searches_per_s times a second of the world's clock: a sphere is cast along it, from the
// part's end that is nearer to the head. The last result is reused while no surface near the part
// has moved and both ends have moved by less than k_part_moved_m. It is never reused if
// SurfaceQuery::hash_near returns nullopt. In frames between searches the plane moves with the
// reference velocity. `moved_m`: displacement of the chest relative to it.
void find_body_contacts(const BodySurroundings& around, double t_s, double dt_s,
                        const Vec3& moved_m, SpineMemory& memory);

// The contact of a link's part; null: none.
const BodyContact* contact_of(const SpineMemory& memory, std::size_t link);

// Turns a link's direction, in its parent's frame, until the link's lower end is in front of the
// surface. The speed of the lower end is limited, so that a link that starts inside a wall moves
// out without a jump.
Vec3 before_surface(const Vec3& towards, const Vec3& base_m, double length_m,
                    const SpineFrame& above, const BodyContact& contact);

// Returns the velocity of a joint after a correction that a surface took part in. The joint neither
// moves into the surface, nor away from it faster than before.
Vec3 touching_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps);

}  // namespace handhold
