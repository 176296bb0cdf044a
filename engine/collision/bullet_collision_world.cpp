// Bullet finds the candidates (btDbvt over moving bounds, a quantised tree over each mesh's
// triangles), casts rays on triangles and, in bullet_convex and bullet_sweep, measures distances,
// clips faces and sweeps. What stays closed forms of our own, and why: docs/decisions.md, 5.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <LinearMath/btAlignedAllocator.h>

#include "engine/collision/bounds.hpp"
#include "engine/collision/bullet_sweep.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/collision/pair_contact.hpp"
#include "engine/collision/pair_memory.hpp"
#include "engine/collision/shape_query.hpp"
#include "engine/core/check.hpp"

namespace handhold {
namespace {

std::atomic<std::uint64_t> g_allocations{0};

void* counted_allocate(std::size_t size) {
    g_allocations.fetch_add(1, std::memory_order_relaxed);
    return std::malloc(size);
}

// Memory from before the hook is freed by the same function: Bullet's default is malloc too.
void hook_allocator() {
    static std::once_flag once;
    std::call_once(once, [] { btAlignedAllocSetCustom(&counted_allocate, &std::free); });
}

btDbvtVolume to_volume(const Bounds& bounds) {
    return btDbvtVolume::FromMM(to_bullet(bounds.low), to_bullet(bounds.high));
}

// Overlaps nothing and widens no node above it.
btDbvtVolume empty_volume() { return to_volume({Vec3::Constant(1e30), Vec3::Constant(-1e30)}); }

// The triangles of one mesh, found by box or ray. Holds no copy of the mesh.
class TriangleTree {
  public:
    explicit TriangleTree(const Mesh& mesh) : mesh_(mesh) {
        btIndexedMesh part;
        part.m_numTriangles = static_cast<int>(mesh.triangles.size());
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles.data());
        part.m_triangleIndexStride = sizeof(mesh.triangles[0]);
        part.m_numVertices = static_cast<int>(mesh.positions.size());
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.positions.data());
        part.m_vertexStride = sizeof(Vec3);
        part.m_vertexType = PHY_DOUBLE;
        parts_.addIndexedMesh(part);
        shape_ = std::make_unique<btBvhTriangleMeshShape>(&parts_, true);
    }

    // visit(corners) for at least every triangle whose bounds meet the box.
    template <typename Visit>
    void visit_box(const Bounds& box, const Visit& visit) const {
        Callback callback(mesh_, visit);
        shape_->processAllTriangles(&callback, to_bullet(box.low), to_bullet(box.high));
    }
    // First triangle on the way, from either side.
    std::optional<LocalRayHit> cast_ray(const Vec3& from, const Vec3& to) const {
        struct Nearest final : btTriangleRaycastCallback {
            using btTriangleRaycastCallback::btTriangleRaycastCallback;
            btScalar reportHit(const btVector3& unit_normal, btScalar fraction, int /*part*/,
                               int /*index*/) override {
                hit = LocalRayHit{fraction, from_bullet(unit_normal)};
                return fraction;
            }
            std::optional<LocalRayHit> hit;
        };
        Nearest callback(to_bullet(from), to_bullet(to));
        shape_->performRaycast(&callback, to_bullet(from), to_bullet(to));
        return callback.hit;
    }

  private:
    template <typename Visit>
    class Callback final : public btTriangleCallback {
      public:
        Callback(const Mesh& mesh, const Visit& visit) : mesh_(mesh), visit_(visit) {}
        void processTriangle(btVector3* /*corners*/, int /*part*/, int index) override {
            const auto& corner = mesh_.triangles[static_cast<std::size_t>(index)];
            visit_(Corners{mesh_.positions[corner[0]], mesh_.positions[corner[1]],
                           mesh_.positions[corner[2]]});
        }

      private:
        const Mesh& mesh_;
        const Visit& visit_;
    };

    const Mesh& mesh_;
    btTriangleIndexVertexArray parts_;
    std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

Corners moved(const Corners& corners, const Vec3& by) {
    return {corners[0] + by, corners[1] + by, corners[2] + by};
}

// Nearest point of a mesh within max_distance_m. Boxes grow about the point until one holds a
// triangle that is nearer than its side.
std::optional<LocalSurfacePoint> closest_on_triangles(const TriangleTree& triangles,
                                                      const Vec3& point, double max_distance_m) {
    std::optional<LocalSurfacePoint> best;
    double reach_m = max_distance_m / 32.0;
    do {
        reach_m = std::min(2.0 * reach_m, max_distance_m);
        double nearest_m = reach_m;
        triangles.visit_box(bounds_of(point, point).grown(reach_m), [&](const Corners& corners) {
            const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            if ((point.cwiseMax(low).cwiseMin(high) - point).squaredNorm() >
                nearest_m * nearest_m) {
                return;
            }
            const LocalSurfacePoint near = closest_on_triangle_surface(corners, point);
            if (best ? near.distance_m < nearest_m : near.distance_m <= nearest_m) {
                nearest_m = near.distance_m;
                best = near;
            }
        });
    } while (!best && reach_m < max_distance_m);
    return best;
}

struct ShapeCache {
    ShapeExtent extent;
    std::unique_ptr<TriangleTree> triangles;  // null for convex shapes
    std::unique_ptr<ConvexShape> convex;      // null for meshes
};

struct Body {
    ColliderProxy proxy;
    Bounds bounds_ws;            // of the whole way from from_ws to to_ws
    btDbvtNode* leaf = nullptr;  // null: left out, its pose is not valid
};

bool same_pose(const Pose& a, const Pose& b) {
    return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

bool same_proxy(const ColliderProxy& a, const ColliderProxy& b) {
    return a.id == b.id && a.shape == b.shape && a.free == b.free &&
           same_pose(a.from_ws, b.from_ws) && same_pose(a.to_ws, b.to_ws);
}

bool contains(std::span<const std::uint64_t> ids, std::uint64_t id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

struct CollisionWorld::Impl {
    explicit Impl(const ShapeLibrary& library) : shapes(library), cache(library.size()) {
        for (std::size_t i = 0; i < cache.size(); ++i) {
            const Shape& shape = library.at({static_cast<std::uint32_t>(i)});
            cache[i].extent = shape_extent(shape);
            if (shape.kind == ShapeKind::mesh) {
                cache[i].triangles = std::make_unique<TriangleTree>(*shape.mesh);
            } else {
                cache[i].convex = std::make_unique<ConvexShape>(shape);
            }
        }
        stack.reserve(256);
    }

    void check(std::span<const ColliderProxy> proxies) const;
    void set_proxies(std::span<const ColliderProxy> proxies);
    void place(Body& body);
    void park(Body& body);
    void find_bodies(const Bounds& box) const;
    // visit(proxy, shape, cache of the shape) for the bodies that may meet the box, by rising id.
    template <typename Visit>
    void visit_bodies(const Bounds& box, std::span<const std::uint64_t> skip,
                      const Visit& visit) const {
        find_bodies(box);
        for (const std::size_t index : found) {
            const ColliderProxy& proxy = bodies[index].proxy;
            if (!contains(skip, proxy.id)) {
                visit(proxy, shapes.at(proxy.shape), cache[proxy.shape.index]);
            }
        }
    }
    void find_pair(const Body& a, const Body& b, const ContactLimits& limits,
                   std::vector<ContactPoint>& contacts);
    bool is_pair(const Body& a, const Body& b) const;

    const ShapeLibrary& shapes;
    std::vector<ShapeCache> cache;
    std::vector<Body> bodies;       // sorted by id
    std::vector<Body> next_bodies;  // the list under construction: the two swap
    std::vector<IgnoredPair> ignored;
    btDbvt tree;
    std::vector<btDbvtNode*>
        parked;  // leaves without a body, kept in the tree: Bullet frees a removed leaf's memory
    PairScratch scratch;
    PairMemory memory;
    ConvexShape sphere{Shape{}};  // of cast_sphere
    // Results of find_bodies: indices into `bodies`, in their order.
    mutable std::vector<std::size_t> found;
    mutable btAlignedObjectArray<const btDbvtNode*> stack;
};

void CollisionWorld::Impl::check(std::span<const ColliderProxy> proxies) const {
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const ColliderProxy& proxy = proxies[i];
        HH_CHECK(proxy.id > (i > 0 ? proxies[i - 1].id : 0), "ids must rise from 1", proxy.id);
        HH_CHECK(proxy.shape.index < cache.size(), "no shape with this id", proxy.shape.index);
        HH_CHECK(!proxy.free || cache[proxy.shape.index].triangles == nullptr,
                 "a mesh cannot be free", proxy.id);
    }
}

void CollisionWorld::Impl::place(Body& body) {
    if (!is_valid(body.proxy.from_ws) || !is_valid(body.proxy.to_ws)) {
        park(body);
        return;
    }
    body.bounds_ws =
        way_bounds(cache[body.proxy.shape.index].extent, body.proxy.from_ws, body.proxy.to_ws);
    btDbvtVolume volume = to_volume(body.bounds_ws);
    if (body.leaf == nullptr && !parked.empty()) {
        body.leaf = parked.back();
        parked.pop_back();
    }
    if (body.leaf == nullptr) {
        body.leaf = tree.insert(volume, nullptr);
    } else {
        tree.update(body.leaf, volume);
    }
}

void CollisionWorld::Impl::park(Body& body) {
    if (body.leaf != nullptr) {
        btDbvtVolume volume = empty_volume();
        tree.update(body.leaf, volume);
        parked.push_back(body.leaf);
        body.leaf = nullptr;
    }
}

void CollisionWorld::Impl::set_proxies(std::span<const ColliderProxy> proxies) {
    check(proxies);
    next_bodies.clear();
    next_bodies.reserve(std::max(proxies.size(), bodies.capacity()));
    parked.reserve(parked.size() + bodies.size());
    std::size_t old = 0;
    for (const ColliderProxy& proxy : proxies) {
        for (; old < bodies.size() && bodies[old].proxy.id < proxy.id; ++old) {
            park(bodies[old]);
        }
        Body body;
        if (old < bodies.size() && bodies[old].proxy.id == proxy.id) {
            body = bodies[old++];
        }
        const bool changed = !same_proxy(body.proxy, proxy);  // a new body's id is still 0
        body.proxy = proxy;
        if (changed) {
            place(body);
        }
        next_bodies.push_back(body);
    }
    for (; old < bodies.size(); ++old) {
        park(bodies[old]);
    }
    bodies.swap(next_bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].leaf != nullptr) {
            bodies[i].leaf->dataAsInt = static_cast<int>(i);
        }
    }
    found.reserve(bodies.size());
}

// The tree's shape, and so the order in which it answers, depends on its history: sorting takes
// that out again.
void CollisionWorld::Impl::find_bodies(const Bounds& box) const {
    struct Collector final : btDbvt::ICollide {
        explicit Collector(std::vector<std::size_t>& list) : found(list) {}
        void Process(const btDbvtNode* leaf) override {
            found.push_back(static_cast<std::size_t>(leaf->dataAsInt));
        }
        std::vector<std::size_t>& found;
    };
    found.clear();
    Collector collector(found);
    tree.collideTVNoStackAlloc(tree.m_root, to_volume(box), stack, collector);
    std::sort(found.begin(), found.end());
}

bool CollisionWorld::Impl::is_pair(const Body& a, const Body& b) const {
    if (b.proxy.free && a.proxy.id >= b.proxy.id) {
        return false;  // two free bodies meet once, and none meets itself
    }
    const auto [low, high] = std::minmax(a.proxy.id, b.proxy.id);
    return !std::binary_search(ignored.begin(), ignored.end(), IgnoredPair{low, high});
}

void CollisionWorld::Impl::find_pair(const Body& a, const Body& b, const ContactLimits& limits,
                                     std::vector<ContactPoint>& contacts) {
    const Pose from_bs = inverse(b.proxy.from_ws) * a.proxy.from_ws;
    const Pose to_bs = inverse(b.proxy.to_ws) * a.proxy.to_ws;
    scratch.triangles.clear();
    if (const TriangleTree* triangles = cache[b.proxy.shape.index].triangles.get()) {
        const Bounds way =
            way_bounds(cache[a.proxy.shape.index].extent, from_bs, to_bs).grown(limits.margin_m);
        triangles->visit_box(way, [&](const Corners& corners) {
            NearTriangle near;
            if (make_near_triangle(moved(corners, -to_bs.position), near)) {
                scratch.triangles.push_back(near);
            }
        });
        if (scratch.triangles.empty()) {
            return;
        }
    }
    const std::size_t first = contacts.size();
    find_pair_contacts({*cache[a.proxy.shape.index].convex, cache[b.proxy.shape.index].convex.get(),
                        from_bs, to_bs, scratch.triangles, limits, contacts, scratch});
    for (std::size_t i = first; i < contacts.size(); ++i) {
        contacts[i].id_a = a.proxy.id;
        contacts[i].id_b = b.proxy.id;
    }
}

CollisionWorld::CollisionWorld(const ShapeLibrary& shapes) {
    hook_allocator();
    impl_ = std::make_unique<Impl>(shapes);
}

CollisionWorld::~CollisionWorld() = default;

void CollisionWorld::set_proxies(std::span<const ColliderProxy> proxies) {
    impl_->set_proxies(proxies);
}

void CollisionWorld::set_ignored_pairs(std::span<const IgnoredPair> pairs) {
    for (std::size_t i = 1; i < pairs.size(); ++i) {
        HH_CHECK(pairs[i - 1] <= pairs[i], "pairs must be sorted", pairs[i].id_a);
    }
    impl_->ignored.assign(pairs.begin(), pairs.end());
}

void CollisionWorld::find_contacts(const ContactLimits& limits,
                                   std::vector<ContactPoint>& contacts) {
    HH_CHECK(limits.margin_m > 0.0, "margin_m must be positive", limits.margin_m);
    HH_CHECK(limits.sweep_m > 0.0, "sweep_m must be positive", limits.sweep_m);
    contacts.clear();
    PairMemory& memory = impl_->memory;
    memory.begin(limits);
    for (const Body& body : impl_->bodies) {
        memory.add(body.proxy);
    }
    for (std::size_t i = 0; i < impl_->bodies.size(); ++i) {
        const Body& a = impl_->bodies[i];
        if (!a.proxy.free || a.leaf == nullptr) {
            continue;
        }
        impl_->find_bodies(a.bounds_ws.grown(limits.margin_m));
        for (const std::size_t index : impl_->found) {
            const Body& b = impl_->bodies[index];
            if (!impl_->is_pair(a, b) || memory.recall(i, index, contacts)) {
                continue;
            }
            const std::size_t first = contacts.size();
            impl_->find_pair(a, b, limits, contacts);
            memory.note(i, index, std::span(contacts).subspan(first));
        }
    }
}

std::optional<RayHit> CollisionWorld::cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                               std::span<const std::uint64_t> skip) const {
    const Vec3 way_ws = to_ws - from_ws;
    double fraction = std::numeric_limits<double>::infinity();
    std::optional<RayHit> best;
    const auto cast = [&](const ColliderProxy& proxy, const Shape& shape, const ShapeCache& cache) {
        const Vec3 from = inverse_transform_point(proxy.to_ws, from_ws);
        const Vec3 to = inverse_transform_point(proxy.to_ws, to_ws);
        const auto offer = [&](const std::optional<LocalRayHit>& hit) {
            if (hit && hit->fraction < fraction) {
                fraction = hit->fraction;
                const double side = hit->normal.dot(to - from) <= 0.0 ? 1.0 : -1.0;
                best =
                    RayHit{proxy.id, from_ws + fraction * way_ws,
                           proxy.to_ws.rotation * (side * hit->normal), fraction * way_ws.norm()};
            }
        };
        if (cache.triangles != nullptr) {
            offer(cache.triangles->cast_ray(from, to));
        } else {
            offer(cast_ray_on_shape(shape, from, to));
        }
    };
    impl_->visit_bodies(bounds_of(from_ws, to_ws), skip, cast);
    return best;
}

std::optional<RayHit> CollisionWorld::cast_sphere(double radius_m, const Vec3& from_ws,
                                                  const Vec3& to_ws,
                                                  std::span<const std::uint64_t> skip) const {
    HH_CHECK(radius_m > 0.0, "radius_m must be positive", radius_m);
    impl_->sphere.set_sphere_radius(radius_m);
    const double reach_m = radius_m + k_rounding_m;
    double fraction = 1.0;
    std::optional<RayHit> best;
    const auto cast = [&](const ColliderProxy& proxy, const Shape& /*shape*/,
                          const ShapeCache& cache) {
        const Vec3 from =
            inverse_transform_point(proxy.to_ws, from_ws);  // near space lies about it here
        const Vec3 way = inverse_transform_point(proxy.to_ws, to_ws) - from;
        const RelativeMotion motion({}, {way, Quat::Identity()});
        const auto offer = [&](const Convex& b) {
            const auto hit = time_of_impact(impl_->sphere, motion, b, fraction);
            if (hit && (!best || hit->fraction < fraction)) {
                fraction = hit->fraction;
                best = RayHit{proxy.id, transform_point(proxy.to_ws, from + hit->point_b_ns),
                              proxy.to_ws.rotation * hit->normal, fraction * way.norm()};
            }
        };
        if (cache.convex != nullptr) {
            offer(cache.convex->at({-from, Quat::Identity()}));
            return;
        }
        cache.triangles->visit_box(
            bounds_of(from, from + way).grown(reach_m), [&](const Corners& corners) {
                NearTriangle near;
                if (make_near_triangle(moved(corners, -from), near)) {
                    offer(impl_->scratch.triangle.place(near.corners_ns, near.normal));
                }
            });
    };
    impl_->visit_bodies(bounds_of(from_ws, to_ws).grown(reach_m), skip, cast);
    return best;
}

std::optional<SurfacePoint> CollisionWorld::closest_point(
    const Vec3& point_ws, double max_distance_m, std::span<const std::uint64_t> skip) const {
    double reach_m = max_distance_m;
    std::optional<SurfacePoint> best;
    const auto find = [&](const ColliderProxy& proxy, const Shape& shape, const ShapeCache& cache) {
        const Vec3 point = inverse_transform_point(proxy.to_ws, point_ws);
        std::optional<LocalSurfacePoint> near;
        if (cache.triangles == nullptr) {
            near = closest_on_shape(shape, point);
        } else {
            near = closest_on_triangles(*cache.triangles, point, reach_m);
        }
        if (near && (best ? near->distance_m < reach_m : near->distance_m <= reach_m)) {
            reach_m = near->distance_m;
            best = SurfacePoint{proxy.id, transform_point(proxy.to_ws, near->point),
                                proxy.to_ws.rotation * near->normal, near->distance_m};
        }
    };
    impl_->visit_bodies(bounds_of(point_ws, point_ws).grown(max_distance_m), skip, find);
    return best;
}

std::uint64_t collision_allocation_count() { return g_allocations.load(std::memory_order_relaxed); }

}  // namespace handhold
