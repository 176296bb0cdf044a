#pragma once

#include <array>
#include <optional>
#include <string>

#include "game/desktop/desktop_session.hpp"
#include "game/desktop/play_tally.hpp"
#include "game/session/session_history.hpp"
#include "game/view/gizmos.hpp"

namespace handhold {

// What the inspector remembers from one picture to the next. Not state of the world.
struct InspectorMemory {
    GizmoSet gizmos = k_no_gizmos;
    std::string turn_to;  // a page by its name, once; empty: none
    Entity selected = k_no_entity;
    std::array<char, 64> filter{};
    std::array<char, 256> tuning_file{'t', 'u', 'n', 'i', 'n', 'g', '.', 'j', 's', 'o', 'n'};
    std::string tuning_message;  // what became of the last change, of saving or of loading
    std::array<double, static_cast<std::size_t>(Stage::count)> smooth_us{};
    std::array<double, static_cast<std::size_t>(Fallback::count)> counted_at_s{};
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> counted{};
    std::optional<Entity> pointed_hand;  // the one that was last pointed at
};

// What the inspector shows, and what it may change: tuning, between frames.
struct InspectorView {
    DesktopSession& session;
    const SessionHistory& history;
    const PlayTally& tally;
    InspectorMemory& memory;
};
// A panel with a page each for the frame, the hands, tuning, entities and gizmos.
void show_inspector(const InspectorView& view);

// Its pages.
void show_frame_page(const InspectorView& view);
void show_hands_page(const InspectorView& view);
void show_tuning_page(const InspectorView& view);
void show_entities_page(const InspectorView& view);
void show_gizmos_page(const InspectorView& view);

}  // namespace handhold
