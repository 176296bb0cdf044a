#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "components/fields.hpp"
#include "components/world.hpp"
#include "engine/core/check.hpp"

// Walks components down to their leaf values, always in the same order. Used by saving, restoring
// and comparing worlds.
namespace handhold {

// The types at which a walk ends.
template <typename T>
inline constexpr bool k_is_leaf = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
                                  std::is_same_v<T, Entity> || std::is_same_v<T, ShapeId>;

// Base of the visitors, with defaults for most steps. A visitor must add leaf(const T&).
struct FieldVisitor {
    void enter(const char* /*name*/) {}
    void enter(std::size_t /*index*/) {}
    void leave() {}
    // How many elements of an array to walk.
    static std::size_t count_walked(std::size_t size) { return size; }
    // True: the visitor wants to know the types alone, of one element of each list.
    static constexpr bool k_walks_types = false;
    // Called at each list whose length differs between elements of a column.
    void note_list() {}
    // True: the visitor handles the value as a whole; its axes are not walked.
    static bool takes_whole(const Vec3& /*v*/) { return false; }
    static bool takes_whole(const Quat& /*q*/) { return false; }
    // Called after the four axes of a rotation were walked.
    void finish(const Quat& /*q*/) {}
};

// A visitor that knows its path.
class PathVisitor : public FieldVisitor {
  public:
    void enter(const char* name) { push({name, 0}); }
    void enter(std::size_t index) { push({nullptr, index}); }
    void leave() { --depth_; }

    // "entries[3].hand_ps.position.x"
    std::string path() const {
        std::string text;
        for (std::size_t i = 0; i < depth_; ++i) {
            const Step& step = steps_[i];
            if (step.name == nullptr) {
                text += "[" + std::to_string(step.index) + "]";
            } else {
                text += (text.empty() ? "" : ".") + std::string(step.name);
            }
        }
        return text;
    }

  private:
    struct Step {
        const char* name = nullptr;  // null: an array element
        std::size_t index = 0;
    };
    void push(const Step& step) {
        HH_CHECK(depth_ < steps_.size(), "a component is nested too deep", depth_);
        steps_[depth_++] = step;
    }

    std::array<Step, 12> steps_;
    std::size_t depth_ = 0;
};

template <typename Component, typename Visitor>
void walk_component(const Component& component, Visitor& visitor);

template <typename T, typename Visitor>
void walk_axis(const char* name, const T& value, Visitor& visitor) {
    visitor.enter(name);
    visitor.leaf(value);
    visitor.leave();
}

template <typename Visitor>
void walk_field(const Vec3& v, Visitor& visitor) {
    if (!visitor.takes_whole(v)) {
        walk_axis("x", v.x(), visitor);
        walk_axis("y", v.y(), visitor);
        walk_axis("z", v.z(), visitor);
    }
}
template <typename Visitor>
void walk_field(const Quat& q, Visitor& visitor) {
    if (!visitor.takes_whole(q)) {
        walk_axis("x", q.x(), visitor);
        walk_axis("y", q.y(), visitor);
        walk_axis("z", q.z(), visitor);
        walk_axis("w", q.w(), visitor);
        visitor.finish(q);
    }
}
template <typename Visitor>
void walk_field(const Pose& pose, Visitor& visitor) {
    visitor.enter("position");
    walk_field(pose.position, visitor);
    visitor.leave();
    visitor.enter("rotation");
    walk_field(pose.rotation, visitor);
    visitor.leave();
}
template <typename T, typename Visitor>
void walk_field(const T& value, Visitor& visitor) {
    if constexpr (k_is_leaf<T>) {
        visitor.leaf(value);
    } else {
        walk_component(value, visitor);
    }
}
template <typename T, std::size_t N, typename Visitor>
void walk_field(const std::array<T, N>& values, Visitor& visitor) {
    const std::size_t count = visitor.count_walked(N);
    for (std::size_t i = 0; i < count; ++i) {
        visitor.enter(i);
        walk_field(values[i], visitor);
        visitor.leave();
    }
}

// The used elements of a larger array. Their number was walked before them.
template <typename T, typename Visitor>
void walk_field(const std::span<const T>& values, Visitor& visitor) {
    visitor.note_list();
    if constexpr (Visitor::k_walks_types) {
        visitor.count_walked(0);
        visitor.enter(std::size_t{0});
        walk_field(T{}, visitor);
        visitor.leave();
    } else {
        for (std::size_t i = 0; i < values.size(); ++i) {
            visitor.enter(i);
            walk_field(values[i], visitor);
            visitor.leave();
        }
    }
}

template <typename Component, typename Visitor>
void walk_component(const Component& component, Visitor& visitor) {
    visit_fields(component, [&visitor](const char* name, const auto& field) {
        visitor.enter(name);
        walk_field(field, visitor);
        visitor.leave();
    });
}

// The world's data outside its entities and columns.
template <typename Visitor>
void walk_globals(const World& world, Visitor& visitor) {
    visitor.enter("clock");
    walk_axis("frame", world.clock.frame, visitor);
    walk_axis("t_s", world.clock.t_s, visitor);
    visitor.leave();
    visitor.enter("reference_velocity_mps");
    walk_field(world.reference_velocity_mps, visitor);
    visitor.leave();
    visitor.enter("gravity_mps2");
    walk_field(world.gravity_mps2, visitor);
    visitor.leave();
}

}  // namespace handhold
