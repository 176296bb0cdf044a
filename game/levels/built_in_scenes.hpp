#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

// Scenes and sessions that are part of the game, made in code.
namespace handhold {

// The names that make_built_in_scene accepts.
std::vector<std::string_view> built_in_scenes();
// Builds the scene; nullopt for an unknown name.
std::optional<Scene> make_built_in_scene(std::string_view name);

// If the scene's session is the built-in session "station", inserts a first spawn "rail" at the
// place where that session begins. Otherwise does nothing.
void add_session_spawn(SceneFile& scene);

// The first player's recording of the built-in session with this name (SceneSession::built_in), as
// if a headset had recorded it. nullopt for an unknown name.
std::optional<Recording> make_built_in_session(std::string_view name);
// The recordings of the session's second player, third player, ...; empty: the first plays alone.
std::vector<Recording> make_built_in_partners(std::string_view name);

}  // namespace handhold
