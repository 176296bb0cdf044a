// Implementation of CollisionWorld. Bullet finds the candidates (btDbvt over swept bounds, a
// quantised tree over each mesh's triangles) and tests rays against triangles. bullet_separation
// and bullet_manifold use Bullet to measure distances and to clip faces. Decisions 10 and 12
// (docs/decisions/) say what is implemented here instead, and why.
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "engine/collision/bullet_world.hpp"
#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_usual_contacts = 16;  // initial capacity per body

// One per thread, because several threads process pairs of one world at the same time.
PairScratch& pair_scratch() {
    thread_local PairScratch scratch;
    return scratch;
}

Corners moved(const Corners& corners, const Vec3& by) {
    return {corners[0] + by, corners[1] + by, corners[2] + by};
}

// A box, larger than a's swept bounds, in which the resting mesh b has no triangles. While a stays
// in this box, the pair needs no narrowphase. nullopt if b moves or no such box is found.
std::optional<Bounds> find_clear_box(const BroadphaseBody& a, const ColliderProxy& b,
                                     const ScaledTriangles& triangles, double margin_m) {
    constexpr std::array k_slacks_m = {k_isolation_reach_m, 0.2 * k_isolation_reach_m};
    if (!same_pose(b.from_ws, b.to_ws)) {
        return std::nullopt;
    }
    const Pose to_b = inverse(b.to_ws);
    for (const double slack_m : k_slacks_m) {
        const Bounds box_ws = a.bounds_ws.grown(margin_m + slack_m);
        if (!triangles.may_meet(transformed(box_ws, to_b))) {
            return box_ws;
        }
    }
    return std::nullopt;
}

// True only if a's centre stays farther than `reach_m` from b's in b's frame. Cheaper than the
// poses in that frame: a point whose path is L long and ends at the distances d0 and d1 is never
// nearer than (d0 + d1 - L) / 2. b's rotation lengthens the path by at most 2 sin(angle / 2) d0.
bool stays_beyond(const ColliderProxy& a, const ColliderProxy& b, double reach_m) {
    const Vec3 from = a.from_ws.position - b.from_ws.position;
    const Vec3 to = a.to_ws.position - b.to_ws.position;
    const double from_m = from.norm();
    const double to_m = to.norm();
    const double half_sine = (b.from_ws.rotation.conjugate() * b.to_ws.rotation).vec().norm();
    const double path_m = (to - from).norm() + 2.0 * half_sine * from_m;
    return 0.5 * (from_m + to_m - path_m) > reach_m + k_rounding_m;
}

}  // namespace

std::shared_ptr<const TriangleTree> CollisionWorld::Impl::tree_of(
    const std::shared_ptr<const Mesh>& mesh) {
    std::weak_ptr<const TriangleTree>& known = trees[mesh.get()];
    std::shared_ptr<const TriangleTree> tree = known.lock();
    if (tree == nullptr) {
        tree = std::make_shared<const TriangleTree>(*mesh);
        known = tree;
    }
    return tree;
}

void CollisionWorld::Impl::update_shapes() {
    if (shapes_revision == shapes.revision()) {
        return;
    }
    cache.resize(shapes.size());
    extents.resize(shapes.size());
    // Removes old trees first: a new mesh may have the address of a removed one, and must not get
    // its tree.
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        if (shapes.revision_of({i}) > shapes_revision) {
            cache[i] = {};
        }
    }
    std::erase_if(trees, [](const auto& known) { return known.second.expired(); });
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        if (shapes.revision_of({i}) <= shapes_revision || !shapes.has({i})) {
            continue;
        }
        const Shape& shape = shapes.at({i});
        if (shape.kind == ShapeKind::mesh) {
            cache[i].triangles.emplace(tree_of(shape.mesh), shape.scale);
        } else {
            cache[i].parts = make_parts(shape);
        }
        extents[i] = shape_extent(shape);
    }
    shapes_revision = shapes.revision();
}

void CollisionWorld::Impl::check(std::span<const ColliderProxy> proxies) const {
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const ColliderProxy& proxy = proxies[i];
        HH_CHECK(proxy.id > (i > 0 ? proxies[i - 1].id : 0), "ids must rise from 1", proxy.id);
        check(proxy);
    }
}

void CollisionWorld::Impl::check(const ColliderProxy& proxy) const {
    if (proxy.shape == k_no_shape) {
        return;
    }
    HH_CHECK(shapes.has(proxy.shape), "no shape with this id", proxy.shape.index);
    HH_CHECK(!proxy.free || !cache[proxy.shape.index].triangles, "a mesh cannot be free", proxy.id);
}

std::optional<Bounds> CollisionWorld::Impl::find_pair(const BroadphaseBody& a,
                                                      const BroadphaseBody& b,
                                                      const ContactLimits& limits,
                                                      std::vector<ContactPoint>& contacts) const {
    PairScratch& scratch = pair_scratch();
    const CollisionShape& shape_a = cache[a.proxy.shape.index];
    const CollisionShape& shape_b = cache[b.proxy.shape.index];
    const double reach_m = extents[a.proxy.shape.index].radius_m +
                           extents[b.proxy.shape.index].radius_m + limits.margin_m;
    if (!shape_b.triangles && stays_beyond(a.proxy, b.proxy, reach_m)) {
        return std::nullopt;
    }
    const Pose from_bs = inverse(b.proxy.from_ws) * a.proxy.from_ws;
    const Pose to_bs = inverse(b.proxy.to_ws) * a.proxy.to_ws;
    if (!shape_b.triangles) {
        // a's centre moves along a line in b's frame.
        if (closest_on_segment(Vec3::Zero(), from_bs.position, to_bs.position).norm() > reach_m) {
            return std::nullopt;
        }
    } else {
        scratch.triangles.resize(std::max(scratch.triangles.size(), shape_a.parts.size()));
        bool any = false;
        for (std::size_t i = 0; i < shape_a.parts.size(); ++i) {
            NearTriangles& near = scratch.triangles[i];
            const Bounds along = swept_bounds(shape_a.parts[i].extent(), from_bs, to_bs);
            near.clear();
            shape_b.triangles->visit_box(along.grown(limits.margin_m), [&](const Corners& corners) {
                near.add(moved(corners, -to_bs.position));
            });
            near.build();
            any = any || !near.empty();
        }
        if (!any) {
            return find_clear_box(a, b.proxy, *shape_b.triangles, limits.margin_m);
        }
    }
    const std::size_t first = contacts.size();
    find_pair_contacts({shape_a.parts, shape_b.parts, from_bs, to_bs, scratch.triangles, limits,
                        contacts, scratch});
    for (std::size_t i = first; i < contacts.size(); ++i) {
        contacts[i].id_a = a.proxy.id;
        contacts[i].id_b = b.proxy.id;
    }
    return std::nullopt;
}

double CollisionWorld::overlap_m(const ColliderProxy& a, const ColliderProxy& b) const {
    if (a.shape == k_no_shape || b.shape == k_no_shape || !is_valid(a.to_ws) ||
        !is_valid(b.to_ws)) {
        return 0.0;
    }
    const auto at_rest = [this](const ColliderProxy& proxy) {
        BroadphaseBody body;
        body.proxy = proxy;
        body.proxy.from_ws = proxy.to_ws;
        body.bounds_ws = swept_bounds(impl_->extents[proxy.shape.index], proxy.to_ws, proxy.to_ws);
        return body;
    };
    thread_local std::vector<ContactPoint> contacts;
    contacts.clear();
    impl_->find_pair(at_rest(a), at_rest(b), {}, contacts);
    double depth_m = 0.0;
    for (const ContactPoint& contact : contacts) {
        depth_m = std::max(depth_m, -contact.separation_m);
    }
    return depth_m;
}

void CollisionWorld::Impl::find_contacts_of(const BodyPairs& body, const ContactLimits& limits,
                                            std::vector<ContactPoint>& contacts) {
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    for (std::size_t i = body.first; i < body.last; ++i) {
        PairResult& pair = pair_results[i];
        const std::size_t before = contacts.size();
        if (pair.cached) {
            const std::span<const ContactPoint> known = pair.cached->contacts;
            contacts.insert(contacts.end(), known.begin(), known.end());
            pair.clear_ws = pair.cached->clear_ws;
        } else {
            pair.clear_ws = find_pair(bodies[body.body], bodies[pairs[i]], limits, contacts);
        }
        pair.count = contacts.size() - before;
    }
}

CollisionWorld::CollisionWorld(const ShapeLibrary& shapes)
    : impl_(std::make_unique<Impl>(shapes)) {}

CollisionWorld::~CollisionWorld() = default;

std::shared_ptr<const TriangleTree> build_triangle_tree(const Mesh& mesh) {
    return std::make_shared<const TriangleTree>(mesh);
}

void CollisionWorld::offer_tree(const std::shared_ptr<const Mesh>& mesh,
                                const std::shared_ptr<const TriangleTree>& tree) {
    impl_->trees[mesh.get()] = tree;
}

void CollisionWorld::update_shapes() { impl_->update_shapes(); }

void CollisionWorld::set_proxies(std::span<const ColliderProxy> proxies) {
    impl_->update_shapes();
    impl_->check(proxies);
    impl_->broadphase.set_proxies(proxies, impl_->extents);
    ++impl_->proxy_set;
}

std::uint64_t CollisionWorld::proxy_set() const { return impl_->proxy_set; }

void CollisionWorld::update_proxies(std::span<const ColliderProxy> proxies) {
    impl_->update_shapes();
    for (const ColliderProxy& proxy : proxies) {
        impl_->check(proxy);
    }
    impl_->broadphase.update_proxies(proxies, impl_->extents);
}

CollisionWork CollisionWorld::take_work() {
    CollisionWork work = impl_->work;
    work.bounds_updates = impl_->broadphase.last_change() - impl_->counted_changes;
    impl_->counted_changes = impl_->broadphase.last_change();
    work.tree_queries = std::exchange(impl_->broadphase_scratch.tree_queries, 0);
    impl_->work = {};
    return work;
}

int CollisionWorld::broadphase_depth() const { return impl_->broadphase.depth(); }

void CollisionWorld::set_ignored_pairs(std::span<const IgnoredPair> pairs) {
    for (std::size_t i = 1; i < pairs.size(); ++i) {
        HH_CHECK(pairs[i - 1] <= pairs[i], "pairs must be sorted", pairs[i].id_a);
    }
    impl_->ignored_changes.clear();
    std::ranges::set_symmetric_difference(impl_->ignored, pairs,
                                          std::back_inserter(impl_->ignored_changes));
    for (const IgnoredPair& pair : impl_->ignored_changes) {
        impl_->dirty_ids.push_back(pair.id_a);
        impl_->dirty_ids.push_back(pair.id_b);
    }
    if (!impl_->ignored_changes.empty()) {
        impl_->ignored.assign(pairs.begin(), pairs.end());
    }
}

void CollisionWorld::find_contacts(const ContactLimits& limits,
                                   std::vector<ContactPoint>& contacts) {
    HH_CHECK(limits.margin_m > 0.0, "margin_m must be positive", limits.margin_m);
    HH_CHECK(limits.sweep_m > 0.0, "sweep_m must be positive", limits.sweep_m);
    contacts.clear();
    Impl& world = *impl_;
    world.find_pairs(limits.margin_m);
    world.look_up_pairs(limits);
    if (world.found.size() < world.body_pairs.size()) {
        world.found.resize(world.body_pairs.size());
    }
    auto find = [&](std::size_t i) {
        world.found[i].clear();
        // Reserves memory before the first contacts occur, so that a warm frame does not allocate.
        world.found[i].reserve(k_usual_contacts);
        world.find_contacts_of(world.body_pairs[i], limits, world.found[i]);
    };
    parallel_for(world.body_pairs.size(), find);
    for (std::size_t i = 0; i < world.body_pairs.size(); ++i) {
        world.remember(world.body_pairs[i], world.found[i]);
        world.cache_isolation(world.body_pairs[i], limits.margin_m);
        contacts.insert(contacts.end(), world.found[i].begin(), world.found[i].end());
    }
}

}  // namespace handhold
