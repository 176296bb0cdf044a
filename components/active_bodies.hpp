#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace handhold {

// Which bodies of a frame the physics stages look at, by index into FrameGraph::entities.
// Everything the stages keep about the others is as they left it, so bodies at rest cost nothing.
//
// place_colliders notes the bodies whose components changed, the solver stages those that they
// touched. build_constraints turns the noted bodies into those of its frame. If nobody tracks
// changes, all bodies are.
struct ActiveBodies {
    std::vector<std::uint32_t> list;   // of this frame; without order
    std::vector<std::uint32_t> noted;  // changed since the last build_constraints; without order
    bool is_tracked = false;           // place_colliders ran since the last build_constraints
    bool all_changed = true;

    // Makes room for indices below `count`, and forgets everything.
    void reset(std::size_t count) {
        list.clear();
        noted.clear();
        // Indices never exceed these, so that the stages allocate nothing.
        list.reserve(count + 1);
        noted.reserve(count + 1);
        is_listed_.assign(count + 1, 0);
        is_noted_.assign(count + 1, 0);
        all_changed = true;
    }
    // The body changed: it is active in the next frame that is built.
    void note(std::uint32_t body) {
        grow(body);
        if (is_noted_[body] == 0) {
            is_noted_[body] = 1;
            noted.push_back(body);
        }
    }
    // The body is active in this frame and, because the solver touches it, in the next.
    void add(std::uint32_t body) {
        note(body);
        if (is_listed_[body] == 0) {
            is_listed_[body] = 1;
            list.push_back(body);
        }
    }
    // Starts a frame of `count` bodies: the noted ones are active.
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
