#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <handhold/values.hpp>

namespace hh {

// Owner of a world. hh::World (handhold.hpp) has the calls.
class WorldHandle {
  public:
    // Makes an empty world. Check is_valid().
    explicit WorldHandle(const hh_world_def& def) {
        if (hh_world_create(&def, &world_) != HH_OK) {
            world_ = nullptr;
        }
    }
    ~WorldHandle() { hh_world_destroy(world_); }
    // Takes over the world; `other` is empty afterwards.
    WorldHandle(WorldHandle&& other) noexcept : world_(std::exchange(other.world_, nullptr)) {}
    // Exchanges the two.
    WorldHandle& operator=(WorldHandle&& other) noexcept {
        std::swap(world_, other.world_);
        return *this;
    }
    // True unless creation failed or the world was moved from.
    bool is_valid() const { return world_ != nullptr; }
    // The handle of the C interface; null if not valid.
    hh_world* get() { return world_; }
    // The handle of the C interface; null if not valid.
    const hh_world* get() const { return world_; }

  protected:
    // The hit of a query that succeeded and found something.
    static std::optional<Hit> found(hh_result result, const Hit& hit) {
        const bool is_hit = hit.body.generation != 0 || hit.player.generation != 0;
        return result == HH_OK && is_hit ? std::optional(hit) : std::nullopt;
    }
    // The values of a call that fills an array of the caller; none if it fails.
    template <typename T>
    std::vector<T> all(hh_result (*call)(const hh_world*, T*, std::size_t, std::size_t*)) const {
        std::size_t count = 0;
        std::vector<T> values;
        if (call(world_, nullptr, 0, &count) == HH_OK) {
            values.resize(count);
            values.resize(call(world_, values.data(), count, &count) == HH_OK ? count : 0);
        }
        return values;
    }
    // The list of a call that lends one; empty if it fails.
    template <typename T>
    std::span<const T> list(hh_result (*call)(const hh_world*, const T**, std::size_t*)) const {
        const T* first = nullptr;
        std::size_t count = 0;
        return call(world_, &first, &count) == HH_OK ? std::span(first, count)
                                                     : std::span<const T>();
    }
    // The value that a call writes, with its result.
    template <typename T, typename Call>
    static Maybe<T> make(const Call& call) {
        T value{};
        const hh_result result = call(&value);
        return {result, value};
    }

    // Null if not valid.
    hh_world* world_ = nullptr;
};

}  // namespace hh
