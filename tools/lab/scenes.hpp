#pragma once

#include "tools/lab/lab_scene.hpp"

// One function per scene; make_scene finds them by name.
namespace handhold::lab {

LabScene make_chain(const SceneOptions& options);
LabScene make_ring(const SceneOptions& options);
LabScene make_teleport(const SceneOptions& options);
LabScene make_hub(const SceneOptions& options);

LabScene make_lever(const SceneOptions& options);
LabScene make_drawer(const SceneOptions& options);
LabScene make_door(const SceneOptions& options);

LabScene make_two_hands(const SceneOptions& options);
LabScene make_two_players(const SceneOptions& options);
LabScene make_contradict(const SceneOptions& options);
LabScene make_climb(const SceneOptions& options);

LabScene make_shove(const SceneOptions& options);
LabScene make_shove_mesh(const SceneOptions& options);
LabScene make_step(const SceneOptions& options);
LabScene make_lean_in(const SceneOptions& options);
LabScene make_heap(const SceneOptions& options);
LabScene make_impact(const SceneOptions& options);
LabScene make_debris(const SceneOptions& options);
LabScene make_overlap(const SceneOptions& options);
LabScene make_jam(const SceneOptions& options);
LabScene make_bounce(const SceneOptions& options);
LabScene make_slide(const SceneOptions& options);

LabScene make_wave(const SceneOptions& options);
LabScene make_ship_kinematic(const SceneOptions& options);
LabScene make_ship_dynamic(const SceneOptions& options);
LabScene make_push_off(const SceneOptions& options);
LabScene make_throw(const SceneOptions& options);

}  // namespace handhold::lab
