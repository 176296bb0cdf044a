// Asset hash: the content of every shape, in library order.
#include <map>

#include "engine/core/hash.hpp"
#include "systems/snapshot/snapshot.hpp"

namespace handhold {
namespace {

void add(HashStream& stream, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
        stream.add(v[axis]);
    }
}

std::uint64_t hash_of(const Mesh& mesh) {
    HashStream stream;
    stream.add(std::uint64_t{mesh.positions.size()});
    for (const Vec3& position : mesh.positions) {
        add(stream, position);
    }
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            stream.add(std::uint64_t{corner});
        }
    }
    return stream.value();
}

class ShapeHasher {
  public:
    explicit ShapeHasher(HashStream& stream) : stream_(stream) {}

    // A hull is identified by its corners; its faces follow from them.
    void add_shape(const Shape& shape) {
        stream_.add(static_cast<std::uint64_t>(shape.kind));
        add(stream_, shape.half_m);
        stream_.add(shape.radius_m);
        stream_.add(shape.half_height_m);
        add(stream_, shape.scale);
        if (shape.hull != nullptr) {
            stream_.add(std::uint64_t{shape.hull->corners.size()});
            for (const Vec3& corner : shape.hull->corners) {
                add(stream_, corner);
            }
        }
        if (shape.mesh != nullptr) {
            const auto [known, is_new] = meshes_.try_emplace(shape.mesh.get());
            if (is_new) {  // shapes may share a mesh: hash it once
                known->second = hash_of(*shape.mesh);
            }
            stream_.add(known->second);
        }
        if (shape.parts != nullptr) {
            stream_.add(std::uint64_t{shape.parts->size()});
            for (const PlacedShape& part : *shape.parts) {
                add_shape(part.shape);
                add(stream_, part.pose.position);
                add(stream_, Vec3(part.pose.rotation.vec()));
                stream_.add(part.pose.rotation.w());
                stream_.add(part.mass_kg);
            }
        }
    }

  private:
    HashStream& stream_;
    std::map<const Mesh*, std::uint64_t> meshes_;
};

}  // namespace

SnapshotAssets::SnapshotAssets(const ShapeLibrary& shapes, std::string_view scene)
    : shapes_(&shapes) {
    HashStream stream;
    stream.add(hash_text(scene));
    ShapeHasher hasher(stream);
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        if (shapes.has({i})) {
            hasher.add_shape(shapes.at({i}));
        } else {
            // A removed shape keeps its place, so that later ids do not shift.
            stream.add(std::uint64_t{0});
        }
    }
    hash_ = stream.value();
}

}  // namespace handhold
