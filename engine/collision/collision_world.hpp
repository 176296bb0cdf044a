#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/shape_library.hpp"
#include "engine/math/math.hpp"

// Broadphase, narrowphase and queries behind one interface without a type of the library that does
// them (Bullet).
namespace handhold {

// One collider for the length of one call to find_contacts: where it was when it last touched
// nothing wrongly, and where it is.
struct ColliderProxy {
    std::uint64_t id = 0;  // persistent id; unique among proxies, not 0
    ShapeId shape;         // k_no_shape: passed over
    Pose from_ws;          // last valid pose
    Pose to_ws;  // present pose: contacts are found here, or where the way from from_ws first meets
                 // something
    bool free = false;  // two colliders that are both not free never make contacts
};
// Bit for bit, both.
inline bool same_pose(const Pose& x, const Pose& y) {
    return x.position == y.position && x.rotation.coeffs() == y.rotation.coeffs();
}
// True where a pair of them meets as it did.
inline bool same_proxy(const ColliderProxy& a, const ColliderProxy& b) {
    return a.id == b.id && a.shape == b.shape && a.free == b.free &&
           same_pose(a.from_ws, b.from_ws) && same_pose(a.to_ws, b.to_ws);
}

// A pair of colliders that must not touch each other's bodies: a held rock and its holder's head.
struct IgnoredPair {
    std::uint64_t id_a = 0;  // id_a < id_b
    std::uint64_t id_b = 0;
    friend auto operator<=>(const IgnoredPair&, const IgnoredPair&) = default;
};

// One point where two colliders touch or nearly do. Only local data: the separation follows the
// bodies as separation = normal_ws . (point_a_ws - point_b_ws), negative where they overlap.
struct ContactPoint {
    std::uint64_t id_a = 0;  // always a free collider
    std::uint64_t id_b =
        0;  // the one whose frame holds the normal; where both are free id_a < id_b
    Vec3 point_a_bs = Vec3::Zero();    // on a's surface, in a's frame
    Vec3 point_b_bs = Vec3::Zero();    // on b's surface, in b's frame
    Vec3 normal_b_bs = Vec3::UnitY();  // unit, from b towards a, in b's frame
    double separation_m = 0.0;         // at a's and b's to_ws
    std::uint32_t feature =
        0;  // rank within the pair, by the point's place: stable for equal input
};

struct ContactLimits {
    double margin_m = 0.02;  // contacts farther apart than this are left out; > 0
    double sweep_m =
        0.005;  // colliders that moved farther than this against each other are swept; > 0
};

struct RayHit {
    std::uint64_t id = 0;
    Vec3 point_ws = Vec3::Zero();
    Vec3 normal_ws =
        Vec3::UnitY();  // unit, towards the side the ray came from, whatever the triangle's winding
    double distance_m = 0.0;  // from the ray's start
};

struct SurfacePoint {
    std::uint64_t id = 0;
    Vec3 point_ws = Vec3::Zero();
    Vec3 normal_ws = Vec3::UnitY();  // unit, from the surface point towards the query point
                                     // (outward where they meet)
    double distance_m = 0.0;         // 0 inside of a solid; point_ws is on the surface there too
};

// A cache over proxies, not state: a new one that is given the same proxies answers the same, bit
// for bit. The const queries may run on any number of threads at the same time; nothing else beside
// them or itself.
class CollisionWorld {
  public:
    // Builds the acceleration structure of every mesh. `shapes` must outlive the world and not
    // change.
    explicit CollisionWorld(const ShapeLibrary& shapes);
    ~CollisionWorld();
    CollisionWorld(const CollisionWorld&) = delete;
    CollisionWorld& operator=(const CollisionWorld&) = delete;

    // Replaces all proxies: sorted by id, ids unique, meshes not free (PreconditionError
    // otherwise). One whose poses are not valid (is_valid) takes no part until they are. What did
    // not change costs nothing but the comparison. No allocation once the largest number of proxies
    // has been seen.
    void set_proxies(std::span<const ColliderProxy> proxies);
    // Replaces the pairs that make no contacts; sorted.
    void set_ignored_pairs(std::span<const IgnoredPair> pairs);

    // Contacts between all pairs with at least one free collider. Nothing of an earlier call shows:
    // what did not move since the last call has, bit for bit, the contacts it would have in a new
    // world. Replaces `contacts`; sorted by (id_a, id_b, feature). The
    // bodies are shared out over the threads of parallel_for: the contacts do not depend on how
    // many.
    //
    // A pair that moved less than limits.sweep_m against each other is met at to_ws. Else a's way,
    // relative to b, is swept from from_ws to to_ws, and the contacts are those at the place of
    // first touch of any of their parts. A touch that leaves a no deeper at the end than a tenth of
    // sweep_m, or of the thinner body's least half extent, is no stop: what slides along a floor
    // still meets the wall.
    //
    // Walls have no inside: where a's centre went through a mesh between from_ws and to_ws
    // (relative to b), the normals face the side it came from and depth is measured to that side.
    // Elsewhere they face a's centre. Winding never matters. Of a compound each part has its own
    // centre.
    //
    // Separations are exact where the bodies are apart, and along the least way out where they
    // overlap. Of many points with one normal only the corners of their outline, at most 8, and the
    // deepest are given.
    void find_contacts(const ContactLimits& limits, std::vector<ContactPoint>& contacts);

    // First surface on the way between two points of the world, from outside or inside, colliders
    // at to_ws; those with ids in `skip` are passed through.
    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip = {}) const;
    // First touch of a sphere moved along a line; distance_m is that of its centre from the start,
    // 0 where it starts in touch.
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip = {}) const;
    // Nearest point on any surface within max_distance_m of the point. Exact on triangles (double
    // precision, closed form).
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip = {}) const;
    // The same on the collider with this id alone, however far it is; none where there is none.
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// The collision library's allocations since the process began (its allocator is hooked when the
// first world is made): for tests that count them.
std::uint64_t collision_allocation_count();

}  // namespace handhold
