#pragma once

// The values of handhold.hpp: ids, results, defaults and meshes.

#if !defined(_MSVC_LANG) && __cplusplus < 202002L || defined(_MSVC_LANG) && _MSVC_LANG < 202002L
#error "handhold.hpp needs C++20 (target_compile_features(... cxx_std_20) or -std=c++20)"
#endif

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include <handhold/handhold.h>

// Ids compare by value.
#define HANDHOLD_COMPARABLE(Id)                                    \
    constexpr bool operator==(Id a, Id b) {                        \
        return a.index == b.index && a.generation == b.generation; \
    }
HANDHOLD_COMPARABLE(hh_shape)
HANDHOLD_COMPARABLE(hh_body)
HANDHOLD_COMPARABLE(hh_joint)
HANDHOLD_COMPARABLE(hh_player)
#undef HANDHOLD_COMPARABLE

namespace hh {

using Vec3 = hh_vec3;
using Quat = hh_quat;
using Pose = hh_pose;
using Shape = hh_shape;
using Body = hh_body;
using Joint = hh_joint;
using Player = hh_player;
using Sample = hh_tracking_sample;
using Event = hh_event;
using Hit = hh_hit;
using Side = hh_side;

inline constexpr Quat k_no_turn{0.0, 0.0, 0.0, 1.0};
inline constexpr Pose k_origin{{0.0, 0.0, 0.0}, k_no_turn};
constexpr Pose pose_at(Vec3 position, Quat rotation = k_no_turn) { return {position, rotation}; }

// The result of a call.
class [[nodiscard]] Status {
  public:
    // Takes over a result of the C interface.
    Status(hh_result result) : result_(result) {}  // NOLINT(google-explicit-constructor)
    // True for HH_OK.
    explicit operator bool() const { return result_ == HH_OK; }
    // The result of the C interface.
    hh_result result() const { return result_; }
    // What was wrong. Valid until this thread's next failure.
    std::string_view text() const { return result_ == HH_OK ? "HH_OK" : hh_last_error(); }

  private:
    hh_result result_;
};

// A value, or the result that says why there is none; then the value is all zero.
template <typename T>
class [[nodiscard]] Maybe {
  public:
    // A result and its value; the value counts only for HH_OK.
    Maybe(hh_result result, T value) : status_(result), value_(std::move(value)) {}
    // True if there is a value.
    explicit operator bool() const { return static_cast<bool>(status_); }
    // The status of the call.
    Status status() const { return status_; }
    // The value. Precondition: there is one, which assert checks.
    const T& operator*() const& { return checked(); }
    // The value itself, so that `for (x : *call())` does not refer to a temporary. Precondition:
    // there is one.
    T operator*() && { return (checked(), std::move(value_)); }
    // Member of the value. Precondition: there is one.
    const T* operator->() const { return &checked(); }
    // The value, or `other` if there is none.
    T value_or(T other) const { return *this ? value_ : std::move(other); }

  private:
    const T& checked() const {
        assert(status_ && "the call failed: see status().text()");
        return value_;
    }

    Status status_;
    T value_;
};

// Definitions with their defaults. Change fields by name; designated initialisers would set all
// other fields to 0, which is not every field's default.
inline hh_world_def world_def() { return hh_default_world_def(); }
inline hh_body_def body_def() { return hh_default_body_def(); }
inline hh_joint_def joint_def() { return hh_default_joint_def(); }
inline hh_player_def player_def() { return hh_default_player_def(); }
inline hh_grip_def grip_def() { return hh_default_grip_def(); }
inline Sample sample() { return hh_default_tracking_sample(); }

// The input of one player for one step. Points to `samples`, which must live until the step.
inline hh_player_input input(Player player, std::span<const Sample> samples,
                             const hh_commands& commands = {}) {
    hh_player_input made = hh_default_player_input();
    made.player = player;
    made.samples = samples.data();
    made.sample_count = samples.size();
    made.commands = commands;
    return made;
}

// Triangles, prepared for collision and hands by the constructor. Any thread.
class Mesh {
  public:
    Mesh() = default;
    // `xyz`: three coordinates per vertex. If hh_mesh_create fails, is_valid is false.
    Mesh(std::span<const float> xyz, std::span<const std::uint32_t> indices,
         bool fits_hands = true) {
        hh_mesh_def def = hh_default_mesh_def();
        def.positions = xyz.data();
        def.vertex_count = xyz.size() / 3;
        def.indices = indices.data();
        def.index_count = indices.size();
        def.fits_hands = fits_hands;
        if (hh_mesh_create(&def, &mesh_) != HH_OK) {
            mesh_ = nullptr;
        }
    }
    ~Mesh() { hh_mesh_destroy(mesh_); }
    // Takes over the mesh; `other` is empty afterwards.
    Mesh(Mesh&& other) noexcept : mesh_(std::exchange(other.mesh_, nullptr)) {}
    // Exchanges the two.
    Mesh& operator=(Mesh&& other) noexcept {
        std::swap(mesh_, other.mesh_);
        return *this;
    }
    // True unless creation failed or the mesh was moved from.
    bool is_valid() const { return mesh_ != nullptr; }
    // The handle of the C interface; null if not valid.
    const hh_mesh* get() const { return mesh_; }

  private:
    hh_mesh* mesh_ = nullptr;
};

}  // namespace hh
