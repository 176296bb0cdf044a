#pragma once

#include <array>
#include <optional>
#include <string>

#include "game/play/desktop_session.hpp"
#include "game/play/play_tally.hpp"
#include "game/play/session_history.hpp"
#include "game/view/gizmos.hpp"

namespace handhold {

// What the inspector remembers between pictures. Not state of the world.
struct InspectorMemory {
    GizmoSet gizmos = k_no_gizmos;
    std::string turn_to;  // name of a page to switch to once; empty: none
    Entity selected = k_no_entity;
    std::array<char, 64> filter{};
    std::array<char, 256> tuning_file{'t', 'u', 'n', 'i', 'n', 'g', '.', 'j', 's', 'o', 'n'};
    std::string tuning_message;  // result of the last change, save or load
    std::array<double, static_cast<std::size_t>(Stage::count)> smooth_us{};
    std::array<double, static_cast<std::size_t>(Fallback::count)> counted_at_s{};
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> counted{};
    std::optional<Entity> pointed_hand;  // hand last pointed at
};

// What the inspector shows, and the tuning that it may change between frames.
struct InspectorView {
    DesktopSession& session;
    const SessionHistory& history;
    const PlayTally& tally;
    InspectorMemory& memory;
};
// A panel with pages for the frame, the hands, bodies, tuning, entities and gizmos.
void show_inspector(const InspectorView& view);

// The pages of the inspector.
void show_frame_page(const InspectorView& view);
void show_hands_page(const InspectorView& view);
void show_bodies_page(const InspectorView& view);
void show_tuning_page(const InspectorView& view);
void show_entities_page(const InspectorView& view);
void show_gizmos_page(const InspectorView& view);

}  // namespace handhold
