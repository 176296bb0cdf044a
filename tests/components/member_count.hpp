#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

namespace handhold::test {

// Converts to any member's type.
struct Anything {
    template <typename T>
    operator T() const;  // NOLINT(google-explicit-constructor): never defined, only used in
                         // unevaluated contexts
};

template <typename T, std::size_t... I>
constexpr bool takes_members(std::index_sequence<I...>) {
    return requires { T{(static_cast<void>(I), Anything{})...}; };
}

// The largest number of braced values that initialise T.
template <typename T, std::size_t Limit = 64>
constexpr std::size_t member_count() {
    static_assert(std::is_aggregate_v<T>);
    if constexpr (Limit == 0 || takes_members<T>(std::make_index_sequence<Limit>{})) {
        return Limit;
    } else {
        return member_count<T, Limit - 1>();
    }
}

struct Empty {};
struct ThreeMembers {
    double a = 0.0;
    std::array<Entity, 8> b;
    Vec3 c;
};
static_assert(member_count<Empty>() == 0);
static_assert(member_count<ThreeMembers>() == 3);

}  // namespace handhold::test
