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

// Inserts a first spawn "rail" at the place where the scene's built-in session begins. Does nothing
// if the scene names no built-in session.
void add_session_spawn(SceneFile& scene);

// The session `scene.session->built_in` as if a headset had recorded it. nullopt for an unknown
// name.
std::optional<Recording> make_built_in_session(std::string_view name);
// The sessions of the second player, the third, ...; empty: the first plays alone.
std::vector<Recording> make_built_in_partners(std::string_view name);

}  // namespace handhold
