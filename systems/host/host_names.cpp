// Names of the C interface's events (handhold/players.h).
#include <array>

#include "systems/host/host_world.hpp"

namespace handhold {
namespace {

template <std::size_t N>
const char* name_at(const std::array<const char*, N>& names, int index) {
    return index >= 0 && index < static_cast<int>(N) ? names[static_cast<std::size_t>(index)]
                                                     : nullptr;
}

}  // namespace
}  // namespace handhold

const char* hh_event_kind_name(hh_event_kind kind) {
    constexpr std::array k_names = {"touched",       "grabbed",      "released",
                                    "refused",       "slipped",      "contact_began",
                                    "contact_ended", "latch_closed", "latch_opened",
                                    "limit_reached", "recentred"};
    static_assert(k_names.size() == HH_EVENT_RECENTRED + 1);
    return handhold::name_at(k_names, kind);
}

const char* hh_reason_name(hh_reason reason) {
    constexpr std::array k_names = {
        "none",      "opened",        "no_surface", "not_allowed", "needs_two_hands",
        "stretched", "tracking_lost", "body_gone",  "by_host",     "other_hand"};
    static_assert(k_names.size() == HH_REASON_OTHER_HAND + 1);
    return handhold::name_at(k_names, reason);
}
