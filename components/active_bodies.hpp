#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace handhold {

// Indices into FrameGraph::entities of the bodies that the physics stages process in a frame. The
// data that the stages keep about all other bodies stays unchanged, so bodies at rest cost nothing.
//
// place_colliders notes the bodies whose components changed. The solver stages note the bodies that
// they touched. build_constraints makes the noted bodies the active bodies of its frame, or all
// bodies if place_colliders has not run since its last call.
struct ActiveBodies {
    std::vector<std::uint32_t> list;   // active bodies of this frame, in no particular order
    std::vector<std::uint32_t> noted;  // changed since the last build_constraints; without order
    bool is_tracked = false;           // place_colliders ran since the last build_constraints
    bool all_changed = true;

    // Reserves memory for indices below `count` and clears both lists.
    void reset(std::size_t count) {
        list.clear();
        noted.clear();
        // Each list holds an index at most once, so this capacity is never exceeded.
        list.reserve(count + 1);
        noted.reserve(count + 1);
        is_listed_.assign(count + 1, 0);
        is_noted_.assign(count + 1, 0);
        all_changed = true;
    }
    // Notes that the body changed. It becomes active at the next start_frame.
    void note(std::uint32_t body) {
        grow(body);
        if (is_noted_[body] == 0) {
            is_noted_[body] = 1;
            noted.push_back(body);
        }
    }
    // Makes the body active in this frame. It is active in the next frame too, because the solver
    // touches it.
    void add(std::uint32_t body) {
        note(body);
        if (is_listed_[body] == 0) {
            is_listed_[body] = 1;
            list.push_back(body);
        }
    }
    // Starts a frame of `count` bodies. The noted bodies are active, or all if !is_tracked or
    // all_changed.
    void start_frame(std::size_t count) {
        if (is_listed_.size() <= count) {
            reset(count);
        }
        for (const std::uint32_t body : list) {
            is_listed_[body] = 0;
        }
        if (is_tracked && !all_changed) {
            list.assign(noted.begin(), noted.end());
        } else {
            list.resize(count);
            std::iota(list.begin(), list.end(), 0U);
        }
        for (const std::uint32_t body : noted) {
            is_noted_[body] = 0;
        }
        for (const std::uint32_t body : list) {
            is_listed_[body] = 1;
        }
        noted.clear();
        is_tracked = false;
        all_changed = false;
    }

  private:
    void grow(std::uint32_t body) {
        if (body >= is_noted_.size()) {
            is_noted_.resize(std::size_t{body} + 1, 0);
            is_listed_.resize(std::size_t{body} + 1, 0);
        }
    }

    std::vector<std::uint8_t> is_listed_;
    std::vector<std::uint8_t> is_noted_;
};

}  // namespace handhold
