// Shapes of the C interface (handhold/level.h).
#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "systems/host/host_world.hpp"

namespace handhold {
namespace {

constexpr double k_max_position_m = 1e7;

// Removes a new shape again unless publish() is called, so that a failed call leaves none.
class Unpublished {
  public:
    Unpublished(hh_world& host, ShapeId id) : host_(host), id_(id) {}
    ~Unpublished() {
        if (!is_published_) {
            host_.grip_meshes.remove(host_.shapes, id_);
            host_.shapes.remove(id_);
            host_.may_recycle_shapes = true;
        }
    }
    Unpublished(const Unpublished&) = delete;
    Unpublished& operator=(const Unpublished&) = delete;
    void publish() { is_published_ = true; }

  private:
    hh_world& host_;
    ShapeId id_;
    bool is_published_ = false;
};

// Returns a new id for the shape, after preparing it for collision and hands.
hh_shape publish_shape(hh_world& host, ShapeId id, const Pose& frame, bool is_moved,
                       std::shared_ptr<const GripMesh> grip = nullptr) {
    Unpublished shape_of_host(host, id);
    if (id.index >= host.host_shapes.size()) {
        host.host_shapes.resize(std::size_t{id.index} + 1);
    }
    if (grip != nullptr) {
        host.grip_meshes.insert(host.shapes, id, std::move(grip));
    } else if (host.settings.fits_hands && host.shapes.at(id).kind != ShapeKind::mesh) {
        host.grip_meshes.add(host.shapes, std::array{id});
    }
    host.caches.collision.update_shapes();
    shape_of_host.publish();
    HostShape& shape = host.host_shapes[id.index];
    ++shape.generation;
    shape.frame = frame;
    shape.is_moved = is_moved;
    return {id.index, shape.generation};
}

template <typename Add>
hh_result add_shape(hh_world* world, hh_shape* shape, const Add& add) {
    return call([&] {
        hh_world& host = world_of(world);
        require(shape != nullptr, HH_ERROR_NULL, "the output is null");
        *shape = add(host);
    });
}

// Hulls and compounds: the library's frame is at the centre of mass, along the principal axes.
hh_shape publish_centred(hh_world& host, ShapeId id) {
    Unpublished original(host, id);
    const CentredShape centred = host.shapes.add_centred(id);
    const bool is_moved = centred.shape != id;
    if (!is_moved) {
        original.publish();
    }
    return publish_shape(host, centred.shape, centred.frame, is_moved);
}

std::shared_ptr<const Mesh> copy_mesh(const hh_mesh_def& def) {
    require(def.positions != nullptr && def.indices != nullptr, HH_ERROR_NULL,
            "a mesh needs positions and indices");
    require(
        def.index_count > 0 && def.index_count % 3 == 0 && def.index_count / 3 <= k_max_triangles,
        HH_ERROR_VALUE, "index_count must be a multiple of 3, at most 3 * 2^21");
    constexpr std::size_t k_max_vertices = 3 * k_max_triangles;
    require(def.vertex_count > 0 && def.vertex_count <= k_max_vertices, HH_ERROR_VALUE,
            "vertex_count must lie in [1, 3 * 2^21]");
    constexpr std::size_t k_packed = 3 * sizeof(float);
    constexpr std::size_t k_max_stride = 4096;
    const std::size_t stride = def.vertex_stride == 0 ? k_packed : def.vertex_stride;
    require(stride >= k_packed && stride <= k_max_stride, HH_ERROR_VALUE,
            "vertex_stride must be 0 or lie in [12, 4096]");
    const auto mesh = std::make_shared<Mesh>();
    mesh->positions.reserve(def.vertex_count);
    const char* at = reinterpret_cast<const char*>(def.positions);
    for (std::size_t i = 0; i < def.vertex_count; ++i, at += stride) {
        std::array<float, 3> xyz{};
        std::memcpy(xyz.data(), at, k_packed);
        for (const float axis : xyz) {
            require(std::abs(static_cast<double>(axis)) <= k_max_position_m, HH_ERROR_VALUE, [&] {
                return "vertex " + std::to_string(i) + " lies beyond 1e7 m, or is NaN";
            });
        }
        mesh->positions.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
    mesh->triangles.reserve(def.index_count / 3);
    for (std::size_t i = 0; i < def.index_count; i += 3) {
        const std::array<std::uint32_t, 3> corners = {def.indices[i], def.indices[i + 1],
                                                      def.indices[i + 2]};
        require(std::ranges::max(corners) < def.vertex_count, HH_ERROR_VALUE, [&] {
            return "an index of triangle " + std::to_string(i / 3) + " is not below vertex_count";
        });
        mesh->triangles.push_back(corners);
    }
    return mesh;
}

}  // namespace

ShapeId head_shape(hh_world& host, double wanted_m) {
    const double radius_m = std::max(wanted_m, k_smallest_head_m);
    for (const ShapeId id : host.head_shapes) {
        if (host.shapes.at(id).radius_m == radius_m) {
            return id;
        }
    }
    const ShapeId id = host.shapes.add_sphere(radius_m);
    if (id.index >= host.host_shapes.size()) {
        host.host_shapes.resize(std::size_t{id.index} + 1);
    }
    // Generation 0: no id in the C interface is valid, also not that of a removed shape that had
    // this index.
    host.host_shapes[id.index] = {};
    host.head_shapes.push_back(id);
    host.caches.collision.update_shapes();
    return id;
}

std::size_t shape_count(const hh_world& host) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < host.shapes.size(); ++i) {
        if (host.shapes.has({i})) {
            ++count;
        }
    }
    return count - host.head_shapes.size();
}

}  // namespace handhold

using namespace handhold;

hh_result hh_shape_add_box(hh_world* world, hh_vec3 half_extents_m, hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        return publish_shape(host, host.shapes.add_box(from_c(half_extents_m)), {}, false);
    });
}

hh_result hh_shape_add_sphere(hh_world* world, double radius_m, hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        return publish_shape(host, host.shapes.add_sphere(radius_m), {}, false);
    });
}

hh_result hh_shape_add_capsule(hh_world* world, double radius_m, double half_height_m,
                               hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        return publish_shape(host, host.shapes.add_capsule(radius_m, half_height_m), {}, false);
    });
}

hh_result hh_shape_add_cylinder(hh_world* world, double radius_m, double half_height_m,
                                hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        return publish_shape(host, host.shapes.add_cylinder(radius_m, half_height_m), {}, false);
    });
}

hh_result hh_shape_add_hull(hh_world* world, const hh_vec3* points, size_t count, hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        constexpr std::size_t k_max_points = std::size_t{1} << 20U;
        // Other languages pass an empty array as null.
        require(count >= 4 && count <= k_max_points, HH_ERROR_VALUE, [&] {
            return (count == 0 ? "no points" : std::to_string(count) + " points") +
                   ": a hull needs 4 to 2^20";
        });
        require(points != nullptr, HH_ERROR_NULL, "the points are null");
        std::vector<Vec3> corners;
        for (std::size_t i = 0; i < count; ++i) {
            corners.push_back(checked(points[i], k_max_position_m, "a point beyond 1e7 m, or NaN"));
        }
        return publish_centred(host, host.shapes.add_hull(corners));
    });
}

hh_result hh_shape_add_compound(hh_world* world, const hh_compound_part* parts, size_t count,
                                hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        require(count >= 1 && count <= k_max_parts, HH_ERROR_VALUE, [&] {
            return (count == 0 ? "no parts" : std::to_string(count) + " parts") +
                   ": a compound has 1 to 64";
        });
        require(parts != nullptr, HH_ERROR_NULL, "the parts are null");
        std::vector<CompoundChild> children;
        for (std::size_t i = 0; i < count; ++i) {
            const ShapeId part = shape_of(host, parts[i].shape);
            require(part != k_no_shape, HH_ERROR_HANDLE, "a part's shape is null");
            const Pose pose = checked(parts[i].pose) * host.host_shapes[part.index].frame;
            children.push_back({part, pose, parts[i].mass_kg});
        }
        return publish_centred(host, host.shapes.add_compound(children));
    });
}

hh_result hh_default_mesh_def_sized(hh_mesh_def* filled, size_t size) {
    hh_mesh_def def{};
    def.fits_hands = true;
    return write_default(filled, size, def);
}

hh_result hh_mesh_create(const hh_mesh_def* wanted, hh_mesh** mesh) {
    return call([&] {
        const hh_mesh_def def = read_def(wanted, hh_default_mesh_def());
        require(mesh != nullptr, HH_ERROR_NULL, "the output is null");
        auto made = std::make_unique<hh_mesh>();
        made->mesh = copy_mesh(def);
        made->tree = build_triangle_tree(*made->mesh);
        if (def.fits_hands) {
            made->grip = std::make_shared<const GripMesh>(build_grip_mesh(*made->mesh));
        }
        *mesh = made.release();
    });
}

void hh_mesh_destroy(hh_mesh* mesh) {
    if (mesh != nullptr && --mesh->references == 0) {
        delete mesh;
    }
}

hh_result hh_shape_add_mesh(hh_world* world, const hh_mesh* mesh, hh_vec3 scale, hh_shape* shape) {
    return add_shape(world, shape, [&](hh_world& host) {
        require(mesh != nullptr, HH_ERROR_NULL, "the mesh is null");
        const Vec3 factors = from_c(scale);
        const ShapeId id = host.shapes.add_mesh(mesh->mesh, factors);
        host.caches.collision.offer_tree(mesh->mesh, mesh->tree);
        const bool is_fitted = host.settings.fits_hands && mesh->grip != nullptr;
        if (is_fitted && factors != Vec3::Ones()) {
            host.grip_meshes.add(host.shapes, std::array{id});
        }
        return publish_shape(host, id, {}, false,
                             is_fitted && factors == Vec3::Ones() ? mesh->grip : nullptr);
    });
}

hh_result hh_shape_remove(hh_world* world, hh_shape shape) {
    return call([&] {
        hh_world& host = world_of(world);
        const ShapeId id = shape_of(host, shape);
        require(id != k_no_shape, HH_ERROR_HANDLE, "no shape with this id");
        for (const Collider& collider : host.world.collider.elements()) {
            require(collider.shape != id, HH_ERROR_STATE, "a body or player has the shape");
        }
        host.grip_meshes.remove(host.shapes, id);
        host.shapes.remove(id);
        host.may_recycle_shapes = true;
    });
}

uint8_t hh_shape_is_valid(const hh_world* world, hh_shape shape) {
    return world != nullptr && shape.generation != 0 && world->shapes.has({shape.index}) &&
           shape.index < world->host_shapes.size() &&
           world->host_shapes[shape.index].generation == shape.generation;
}

hh_result hh_world_shape_count(const hh_world* world, size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(count != nullptr, HH_ERROR_NULL, "the output is null");
        *count = shape_count(host);
    });
}
