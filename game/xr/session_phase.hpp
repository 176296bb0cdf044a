#pragma once

#include <cstdint>

namespace handhold {

// OpenXR's session states, with OpenXR's values.
enum class SessionState : std::uint8_t {
    unknown = 0,
    idle = 1,
    ready = 2,
    synchronized = 3,
    visible = 4,
    focused = 5,
    stopping = 6,
    loss_pending = 7,
    exiting = 8
};
enum class SessionDeed : std::uint8_t { none, begin, end, reopen, leave };

// The action that OpenXR demands of a program when its session enters this state.
constexpr SessionDeed deed_on(SessionState state) {
    switch (state) {
        case SessionState::ready:
            return SessionDeed::begin;
        case SessionState::stopping:
            return SessionDeed::end;
        case SessionState::loss_pending:
            return SessionDeed::reopen;
        case SessionState::exiting:
            return SessionDeed::leave;
        default:
            return SessionDeed::none;
    }
}
// True if the player sees the session's pictures.
constexpr bool is_seen(SessionState state) {
    return state == SessionState::visible || state == SessionState::focused;
}

}  // namespace handhold
