#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

// The scenes and sessions that ship with the game, made in code.
namespace handhold {

// The names that make_built_in_scene knows.
std::vector<std::string_view> built_in_scenes();
// Nothing for an unknown name.
std::optional<Scene> make_built_in_scene(std::string_view name);

// Puts a spawn "rail" first, where the built-in session that the scene names begins. Nothing where
// it names none.
void add_session_spawn(SceneFile& scene);

// The session that shows a built-in scene, as if a headset had recorded it:
// `scene.session->built_in` names it. Nothing for an unknown name.
std::optional<Recording> make_built_in_session(std::string_view name);

}  // namespace handhold
