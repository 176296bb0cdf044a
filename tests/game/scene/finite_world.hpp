#pragma once

#include <array>
#include <cmath>
#include <span>
#include <type_traits>

#include "components/fields.hpp"

namespace handhold {

// Visits every number of every column.
class FiniteFields {
  public:
    template <typename T>
    void operator()(const char*, const T& field) {
        look(field);
    }
    bool all() const { return all_; }

  private:
    void look(double value) { all_ = all_ && std::isfinite(value); }
    void look(const Vec3& value) { all_ = all_ && value.allFinite(); }
    void look(const Quat& value) { all_ = all_ && value.coeffs().allFinite(); }
    void look(const Pose& value) {
        look(value.position);
        look(value.rotation);
    }
    void look(Entity) {}
    void look(ShapeId) {}
    template <typename T, std::size_t N>
    void look(const std::array<T, N>& values) {
        look(std::span<const T>(values));
    }
    template <typename T>
    void look(std::span<const T> values) {
        for (const T& value : values) {
            look(value);
        }
    }
    template <typename T>
    void look(const T& value) {
        if constexpr (!std::is_integral_v<T> && !std::is_enum_v<T>) {
            visit_fields(value, *this);
        }
    }

    bool all_ = true;
};

inline bool is_finite_world(const World& world) {
    FiniteFields fields;
    visit_columns(world, [&fields](const char*, const auto& column) {
        for (const auto& element : column.elements()) {
            visit_fields(element, fields);
        }
    });
    return fields.all();
}

}  // namespace handhold
