#pragma once

#include <cstdint>

#include "components/body_fields.hpp"
#include "components/hand_fields.hpp"
#include "components/player_fields.hpp"
#include "components/world.hpp"

// visit_fields(component, visit) calls visit("name", field) for every field of a component. State
// hashes, snapshots and the inspector use it. Components are never copied or hashed as bytes:
// Eigen's types have padding and are not trivially copyable. A test checks that every field is
// visited. An array of which only the first elements are used is visited as a span of those, after
// their number.
//
// Field names are part of the snapshot schema: raise k_format_version in
// systems/snapshot/snapshot.cpp if they change.
namespace handhold {

// Number of values of an enum that components use; valid values are [0, k_value_count). Loading a
// snapshot checks this range. Code that visits an enum without a specialisation does not compile.
template <typename Enum>
inline constexpr std::uint32_t k_value_count = 0;
template <>
inline constexpr std::uint32_t k_value_count<BodyKind> = 3;
template <>
inline constexpr std::uint32_t k_value_count<TrackingState> = 4;
template <>
inline constexpr std::uint32_t k_value_count<HandSide> = 2;
template <>
inline constexpr std::uint32_t k_value_count<GrabEdge> = 3;
template <>
inline constexpr std::uint32_t k_value_count<GripKind> = 5;
template <>
inline constexpr std::uint32_t k_value_count<GrabPhase> = 4;
template <>
inline constexpr std::uint32_t k_value_count<BodyPart> = k_gripped_parts;
template <>
inline constexpr std::uint32_t k_value_count<JointKind> = 5;
template <>
inline constexpr std::uint32_t k_value_count<MotorKind> = 3;
template <>
inline constexpr std::uint32_t k_value_count<LegBone> = 2;
template <>
inline constexpr std::uint32_t k_value_count<ArmGoal> = 3;

}  // namespace handhold
