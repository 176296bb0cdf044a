#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/surface_query.hpp"
#include "engine/geometry/shape_library.hpp"
#include "engine/math/math.hpp"

// Broadphase, narrowphase and queries, behind an interface without types of the underlying library
// (Bullet).
namespace handhold {

// Input of find_contacts and of the queries for one collider.
struct ColliderProxy {
    std::uint64_t id = 0;  // persistent; unique among proxies, not 0
    ShapeId shape;         // k_no_shape: the proxy is ignored
    Pose from_ws;          // last valid (penetration-free) pose: the start of sweeps
    // Current pose. Contacts are computed here, or at the first impact on the motion from from_ws.
    Pose to_ws;
    bool free = false;  // two non-free colliders never make contacts
    // Two colliders make contacts only if each one's layers meet the other's mask. Queries find
    // colliders of all layers.
    std::uint32_t layers = 1;
    std::uint32_t mask = ~0U;
};
// True if the poses are bitwise equal.
inline bool same_pose(const Pose& x, const Pose& y) {
    return x.position == y.position && x.rotation.coeffs() == y.rotation.coeffs();
}
// True if replacing one proxy by the other cannot change a contact.
inline bool same_proxy(const ColliderProxy& a, const ColliderProxy& b) {
    return a.id == b.id && a.shape == b.shape && a.free == b.free && a.layers == b.layers &&
           a.mask == b.mask && same_pose(a.from_ws, b.from_ws) && same_pose(a.to_ws, b.to_ws);
}

// A pair of colliders that makes no contacts, e.g. two bodies connected by a joint.
struct IgnoredPair {
    std::uint64_t id_a = 0;  // id_a < id_b
    std::uint64_t id_b = 0;
    friend auto operator<=>(const IgnoredPair&, const IgnoredPair&) = default;
};

// A contact point of two colliders. After the bodies have moved rigidly, its separation is
// dot(normal_ws, point_a_ws - point_b_ws); negative: penetration.
struct ContactPoint {
    std::uint64_t id_a = 0;  // always a free collider
    // Two free colliders: id_a < id_b.
    std::uint64_t id_b = 0;
    Vec3 point_a_bs = Vec3::Zero();    // point on a's surface, in a's frame
    Vec3 point_b_bs = Vec3::Zero();    // point on b's surface, in b's frame
    Vec3 normal_b_bs = Vec3::UnitY();  // unit, from b towards a, in b's frame
    double separation_m = 0.0;         // separation with both colliders at to_ws
    // Rank within the pair, in order of position: equal input gives equal ranks.
    std::uint32_t feature = 0;
};

struct ContactLimits {
    // Contacts with a larger separation are dropped; > 0. A pair whose sweep touched keeps at least
    // one.
    double margin_m = 0.02;
    // Pairs whose relative displacement exceeds this are swept; > 0.
    double sweep_m = 0.005;
};

// Work of a CollisionWorld, in deterministic units of cost.
struct CollisionWork {
    std::uint64_t narrowphase_calls = 0;  // pairs whose contacts were computed, not recalled
    std::uint64_t bounds_updates = 0;     // proxies that were new or changed
    std::uint64_t tree_queries = 0;       // queries of the broadphase's tree by find_contacts
    // Pairs that find_contacts left out because one of the two bodies overlaps too many others
    // deeply. They are found once those bodies have separated.
    std::uint64_t deferred_pairs = 0;
};

// The BVH of a mesh. Keeps a reference to the mesh, which must outlive it. May be built on any
// thread.
class TriangleTree;
std::shared_ptr<const TriangleTree> build_triangle_tree(const Mesh& mesh);

// The collision state of a set of proxies. A cache, not simulation state: a new world with the same
// proxies gives bitwise the same answers. The const queries are thread-safe. No other member may be
// called while any call is running.
class CollisionWorld {
  public:
    static constexpr bool k_any_thread = true;  // tells SurfaceQuery that any thread may query

    // Builds the BVH of every mesh. `shapes` must outlive the world.
    explicit CollisionWorld(const ShapeLibrary& shapes);
    ~CollisionWorld();
    CollisionWorld(const CollisionWorld&) = delete;
    CollisionWorld& operator=(const CollisionWorld&) = delete;

    // Builds the BVHs of meshes that were added since the last call, and frees those of removed
    // meshes. set_proxies calls it too; a host that calls it first chooses when BVHs are built.
    // Costs nothing if the library is unchanged, otherwise one check per id.
    void update_shapes();
    // Offers a mesh's BVH that was built elsewhere, for instance on a loading thread. The next
    // update_shapes uses it if it still exists by then.
    void offer_tree(const std::shared_ptr<const Mesh>& mesh,
                    const std::shared_ptr<const TriangleTree>& tree);

    // Replaces all proxies. They must be sorted by unique id, and meshes must not be free
    // (PreconditionError). A proxy with an invalid pose (is_valid) is ignored until its poses are
    // valid. An unchanged proxy costs only a comparison. No allocation once the largest number of
    // proxies has been seen.
    void set_proxies(std::span<const ColliderProxy> proxies);
    // Replaces the proxies whose ids occur in `proxies`, in any order. All other proxies stay as
    // they are and cost nothing. Adds and removes no collider: throws PreconditionError if a proxy
    // with a shape has an unknown id, or if one without a shape has a known id.
    void update_proxies(std::span<const ColliderProxy> proxies);
    // Replaces the ignored pairs. `pairs` must be sorted.
    void set_ignored_pairs(std::span<const IgnoredPair> pairs);

    // Computes the contacts of all pairs with at least one free collider. Replaces `contacts`,
    // sorted by (id_a, id_b, feature). The result does not depend on earlier calls: cached pairs
    // are bitwise equal to recomputed ones. Nor does it depend on the number of threads of
    // parallel_for, over which the bodies are distributed.
    //
    // Sweeps: a pair whose relative displacement is below limits.sweep_m is evaluated at to_ws.
    // Otherwise a's motion relative to b is swept from from_ws to to_ws, and the contacts are those
    // at the first impact of any part. An impact is ignored if the rest of the motion adds little
    // penetration: less than a tenth of sweep_m and of the thinner body's smallest half extent. So
    // a body that slides along a floor still reaches the wall.
    //
    // Meshes: surfaces are two-sided; winding is ignored. Normals face a's centre. But if a's
    // centre crossed the mesh between from_ws and to_ws (relative to b), normals face the side that
    // a came from, and depths are measured to that side. Each part of a compound has its own
    // centre.
    //
    // Separations are exact for disjoint bodies, and along the shortest exit for overlapping ones.
    // Among contacts with the same normal, keeps only the deepest and at most 8 corners of their
    // outline.
    void find_contacts(const ContactLimits& limits, std::vector<ContactPoint>& contacts);

    // Depth of the deepest contact of two colliders at their end poses, with the sides of meshes as
    // find_contacts chooses them for colliders at rest; 0 if they do not overlap, or if a is a
    // mesh. Shapes must be those of the last update_shapes; no other state is used.
    double overlap_m(const ColliderProxy& a, const ColliderProxy& b) const;

    // Work since the last call.
    CollisionWork take_work();
    // Number of calls of set_proxies so far. If it has changed since a caller's own set_proxies,
    // another caller has replaced the proxies.
    std::uint64_t proxy_set() const;

    // First surface that the segment hits, from outside or inside. Colliders are at their end poses
    // (ColliderProxy::to_ws). Ignores the ids in `skip`.
    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip = {}) const;
    // First impact of a sphere moving along a segment. distance_m: how far the sphere's centre has
    // moved; 0 if the sphere touches something at the start.
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip = {}) const;
    // Nearest surface point within max_distance_m. Exact on triangles (closed form in double
    // precision).
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip = {}) const;
    // Ids of the colliders whose bounds overlap the box, ascending. Valid until the calling
    // thread's next query.
    std::span<const std::uint64_t> find_near(const Vec3& low_ws, const Vec3& high_ws) const;
    // Hash of the colliders whose bounds at their end poses overlap the box: their ids, shape ids
    // and end poses. If it is unchanged, so are the answers of all queries within the box, unless a
    // shape was removed and its id went to another one.
    std::uint64_t hash_near(const Vec3& low_ws, const Vec3& high_ws,
                            std::span<const std::uint64_t> skip = {}) const;
    // Nearest surface point of the collider `id`, at any distance. nullopt if no collider has this
    // id.
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const;

    // Length of the longest path in the broadphase's tree, which bounds the cost of placing or
    // removing one collider.
    int broadphase_depth() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
