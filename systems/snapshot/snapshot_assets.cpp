// Hashes the content of every shape, and all shapes together in library order.
#include <algorithm>
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

void add(HashStream& stream, const Pose& pose) {
    add(stream, pose.position);
    add(stream, Vec3(pose.rotation.vec()));
    stream.add(pose.rotation.w());
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
    // Hash of a shape's content, of its frame in the host's, and of whether it is a head's; never
    // 0.
    std::uint64_t digest_of(const Shape& shape, const Pose& frame, bool is_head) {
        HashStream stream;
        add_shape(shape, stream);
        add(stream, frame);
        stream.add(std::uint64_t{is_head ? 1U : 0U});
        return std::max<std::uint64_t>(stream.value(), 1);
    }

  private:
    // A hull is identified by its corners; its faces follow from them.
    void add_shape(const Shape& shape, HashStream& stream) {
        stream.add(static_cast<std::uint64_t>(shape.kind));
        add(stream, shape.half_m);
        stream.add(shape.radius_m);
        stream.add(shape.half_height_m);
        add(stream, shape.scale);
        if (shape.hull != nullptr) {
            stream.add(std::uint64_t{shape.hull->corners.size()});
            for (const Vec3& corner : shape.hull->corners) {
                add(stream, corner);
            }
        }
        if (shape.mesh != nullptr) {
            const auto [known, is_new] = meshes_.try_emplace(shape.mesh.get());
            if (is_new) {  // shapes may share a mesh: hash it once
                known->second = hash_of(*shape.mesh);
            }
            stream.add(known->second);
        }
        if (shape.parts != nullptr) {
            stream.add(std::uint64_t{shape.parts->size()});
            for (const PlacedShape& part : *shape.parts) {
                add_shape(part.shape, stream);
                add(stream, part.pose);
                stream.add(part.mass_kg);
            }
        }
    }

    std::map<const Mesh*, std::uint64_t> meshes_;
};

}  // namespace

SnapshotAssets::SnapshotAssets(const ShapeLibrary& shapes, std::string_view scene,
                               const OfHost& host)
    : shapes_(&shapes), heads_(host.heads.begin(), host.heads.end()) {
    HashStream stream;
    stream.add(hash_text(scene));
    scene_hash_ = stream.value();
    ShapeHasher hasher;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        const Pose frame = i < host.frames.size() ? host.frames[i] : Pose{};
        const bool is_a_head = std::ranges::find(heads_, ShapeId{i}) != heads_.end();
        digests_.push_back(shapes.has({i}) ? hasher.digest_of(shapes.at({i}), frame, is_a_head)
                                           : 0);
        stream.add(digests_.back());  // 0 too: the hash depends on the ids
        if (digests_.back() != 0) {
            by_digest_.emplace_back(digests_.back(), i);
        }
    }
    hash_ = stream.value();
    std::ranges::sort(by_digest_);
}

ShapeId SnapshotAssets::find(std::uint64_t digest) const {
    const auto found = std::ranges::lower_bound(by_digest_, std::pair{digest, std::uint32_t{0}});
    return found != by_digest_.end() && found->first == digest ? ShapeId{found->second}
                                                               : k_no_shape;
}

bool SnapshotAssets::is_head(ShapeId shape, double radius_m) const {
    return shapes_->has(shape) && shapes_->at(shape).kind == ShapeKind::sphere &&
           shapes_->at(shape).radius_m == radius_m &&
           (heads_.empty() || std::ranges::find(heads_, shape) != heads_.end());
}

ShapeId SnapshotAssets::find_head(double radius_m) const {
    for (std::uint32_t i = 0; i < shapes_->size(); ++i) {
        if (is_head({i}, radius_m)) {
            return {i};
        }
    }
    return k_no_shape;
}

}  // namespace handhold
