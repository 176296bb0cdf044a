// The state hash. Each element gets a hash of its column's name, its owner's persistent id and its
// fields. These hashes are summed, so the order of elements does not matter.
#include <array>
#include <span>
#include <type_traits>

#include "components/fields.hpp"
#include "engine/core/hash.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {
namespace {

class FieldHasher {
  public:
    FieldHasher(const World& world, HashStream& stream) : world_(world), stream_(stream) {}

    void operator()(const char*, const auto& field) const { add(field); }

  private:
    void add(double value) const { stream_.add(value); }
    void add(const Vec3& v) const {
        for (int axis = 0; axis < 3; ++axis) {
            stream_.add(v[axis]);
        }
    }
    void add(const Quat& q) const {
        add(Vec3(q.vec()));
        stream_.add(q.w());
    }
    void add(const Pose& pose) const {
        add(pose.position);
        add(pose.rotation);
    }
    // Hashes the persistent id, because a handle's slot depends on the pool's history.
    void add(Entity entity) const {
        const PersistentId* const id = world_.persistent_id.find(entity);
        stream_.add(id != nullptr ? id->value : std::uint64_t{0});
    }
    // Not hashed: an index into the asset library, which depends on loading order.
    void add(ShapeId /*shape*/) const {}
    template <typename T, std::size_t N>
    void add(const std::array<T, N>& values) const {
        add(std::span<const T>(values));
    }
    template <typename T>
    void add(std::span<const T> values) const {
        for (const T& value : values) {
            add(value);
        }
    }
    template <typename T>
    void add(const T& value) const {
        if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
            stream_.add(static_cast<std::uint64_t>(value));
        } else {
            visit_fields(value, *this);
        }
    }

    const World& world_;
    HashStream& stream_;
};

// Hash of the columns that visit_members lists, and of the world's data outside of columns.
template <typename VisitMembers>
std::uint64_t hash_columns(const World& world, const VisitMembers& visit_members) {
    std::uint64_t sum = 0;
    visit_members([&](const char* name, auto member) {
        const auto& column = world.*member;
        const std::uint64_t column_name = hash_text(name);
        for (std::size_t index = 0; index < column.size(); ++index) {
            HashStream stream;
            stream.add(column_name);
            stream.add(world.persistent_id.at(column.owners()[index]).value);
            visit_fields(column.elements()[index], FieldHasher(world, stream));
            sum += stream.value();
        }
    });
    HashStream stream;
    stream.add(sum);
    stream.add(world.clock.frame);
    stream.add(world.clock.t_s);
    for (int axis = 0; axis < 3; ++axis) {
        stream.add(world.reference_velocity_mps[axis]);
    }
    if (world.gravity_mps2 != Vec3::Zero()) {  // keeps the hashes of worlds made before gravity
        for (int axis = 0; axis < 3; ++axis) {
            stream.add(world.gravity_mps2[axis]);
        }
    }
    return stream.value();
}

}  // namespace

std::uint64_t hash_state(const World& world) {
    return hash_columns(world, [](auto&& visit) { visit_column_members(visit); });
}

std::uint64_t hash_simulated(const World& world) {
    return hash_columns(world, [](auto&& visit) { visit_simulated_members(visit); });
}

}  // namespace handhold
