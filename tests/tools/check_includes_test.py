"""Creates one breach of each rule in a small tree and expects check_includes to name it; valid trees give no breach."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "check_includes.py"
spec = importlib.util.spec_from_file_location("check_includes", SCRIPT)
check_includes = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_includes)


def breaches(files: dict[str, str]) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return [str(breach) for breach in check_includes.check_tree(root)]


class CheckIncludes(unittest.TestCase):
    def assert_breach(self, file: str, text: str, place_and_words: str):
        found = breaches({file: text})
        self.assertEqual(len(found), 1, found)
        place, words = place_and_words.split(" | ")
        self.assertTrue(found[0].startswith(f"{place}: "), found)
        self.assertIn(words, found[0])

    def assert_clean(self, file: str, text: str):
        self.assertEqual(breaches({file: text}), [])

    def test_downward_includes_are_allowed(self):
        self.assert_clean("engine/a.cpp", '#include "engine/math/math.hpp"\n#include <vector>\n')
        self.assert_clean("components/a.hpp", '#pragma once\n#include "components/b.hpp"\n#include "engine/c.hpp"\n')
        self.assert_clean("systems/grip/search_grip.cpp",
                          '#include "systems/grip/search_grip.hpp"\n#include "components/hand.hpp"\n')
        self.assert_clean("game/commands/main.cpp", '#include "systems/frame/frame.hpp"\n#include "engine/core/hash.hpp"\n')

    def test_upward_includes_are_named_with_their_line(self):
        self.assert_breach("engine/a.cpp", '\n#include "components/b.hpp"\n',
                           "engine/a.cpp:2 | engine does not include components")
        self.assert_breach("components/a.cpp", '#include "systems/frame/frame.hpp"\n',
                           "components/a.cpp:1 | components does not include systems")
        self.assert_breach("systems/frame/frame.cpp", '#include "game/scene/scene.hpp"\n',
                           "systems/frame/frame.cpp:1 | systems does not include game")
        self.assert_breach("game/a.cpp", '#include "tests/a.hpp"\n', "game/a.cpp:1 | game does not include tests")

    def test_only_frame_snapshot_and_host_include_other_systems(self):
        include = '#include "systems/grip/search_grip.hpp"\n'
        self.assert_breach("systems/hand/constrain_palms.cpp", include,
                           "systems/hand/constrain_palms.cpp:1 | no other system")
        self.assert_breach("systems/grip/search_grip_helper.cpp", include,
                           "systems/grip/search_grip_helper.cpp:1 | no other system")
        self.assert_clean("systems/frame/frame.cpp", include)
        self.assert_clean("systems/snapshot/snapshot.cpp", include)
        self.assert_clean("systems/host/open_world.cpp", include)

    def test_system_may_include_shared_files_of_its_own_area_only(self):
        include = '#include "systems/hand/shared/palm_fit.hpp"\n'
        self.assert_clean("systems/hand/constrain_palms.cpp", include)
        self.assert_clean("systems/hand/shared/finger_chain.cpp", include)
        self.assert_breach("systems/grab/update_grabs.cpp", include,
                           "systems/grab/update_grabs.cpp:1 | no other system")
        self.assert_breach("systems/hand/shared/palm_fit.cpp", '#include "systems/hand/search_grip.hpp"\n',
                           "systems/hand/shared/palm_fit.cpp:1 | no other system")

    def test_every_system_may_include_rigs_which_include_only_rigs(self):
        include = '#include "systems/rigs/hand_kinematics.hpp"\n'
        self.assert_clean("systems/hand/constrain_palms.cpp", include)
        self.assert_clean("systems/grab/shared/grab_anchor.hpp", "#pragma once\n" + include)
        self.assert_clean("systems/rigs/hand_rig_fit.cpp", include)
        self.assert_breach("systems/rigs/hand_rig_fit.cpp", '#include "systems/hand/shared/palm_fit.hpp"\n',
                           "systems/rigs/hand_rig_fit.cpp:1 | no other system")
        self.assert_breach("components/hand.hpp", "#pragma once\n" + include,
                           "components/hand.hpp:2 | components does not include systems")

    def test_files_that_play_the_interface_include_no_private_header(self):
        for file in ("game/climber/climber.cpp", "game/session/recording.cpp", "game/devices/desktop_body.cpp", "game/run/spawn.cpp",
                     "game/play/play_tally.cpp", "game/desktop/play_loop.cpp", "game/headset/headset_loop.cpp",
                     "game/commands/play_files.cpp"):
            for path in ("engine/math/math.hpp", "components/tracking.hpp", "systems/frame/frame.hpp"):
                self.assert_breach(file, f'#include "{path}"\n', f"{file}:1 | plays the interface")
            for path in ("handhold/ecs.hpp", "handhold/files.hpp", "handhold/rigs.hpp", "handhold/tuning.hpp"):
                self.assert_breach(file, f"#include <{path}>\n", f"{file}:1 | plays the interface")
            self.assert_clean(file, '#include <handhold/handhold.hpp>\n#include <handhold/math.hpp>\n#include "game/files/file_tools.hpp"\n')
        self.assert_clean("game/play/loading.cpp", '#include "engine/core/work_meter.hpp"\n')
        self.assert_clean("game/view/gizmos.cpp", '#include "components/world.hpp"\n')

    def test_files_that_play_the_interface_name_no_columns(self):
        for file in ("game/climber/climber.cpp", "game/session/playback.cpp", "game/devices/comfort.cpp", "game/run/session_run.cpp",
                     "game/play/desktop_session.cpp"):
            self.assert_breach(file, "\nvoid look(const World& world);\n", f"{file}:2 | names no column")
            self.assert_breach(file, "step_frame(a, b);\n", f"{file}:1 | names no column")
            self.assert_breach(file, "auto& rows = scene_.world().body_pose;\n", f"{file}:1 | names no column")
            self.assert_breach(file, "scene().tuning().hand.reach_m = 1.0;\n", f"{file}:1 | names no column")
            self.assert_breach(file, "columns_of(scene.host.get());\n", f"{file}:1 | names no column")
            self.assert_clean(file, "scene.host.tuning(\"hand.reach_m\");\n")
            self.assert_clean(file, "void look(const hh::World& world);  // not a World\n")
        self.assert_clean("game/desktop/play_loop.cpp", "const World& world();\n")

    def test_private_includes_of_the_game_are_counted_with_those_behind_public_headers(self):
        most = check_includes.MOST_PRIVATE_INCLUDES_OF_GAME
        lines = '#include "engine/math/math.hpp"\n' * most
        self.assert_clean("game/view/a.cpp", lines)
        self.assert_breach("game/view/a.cpp", lines + '#include "engine/math/math.hpp"\n', "game:0 | at most")
        ecs = {"systems/host/include/handhold/ecs.hpp": '#pragma once\n#include <handhold/rigs.hpp>\n#include "engine/a.hpp"\n#include "components/b.hpp"\n',
               "systems/host/include/handhold/rigs.hpp": '#pragma once\n#include "systems/rigs/c.hpp"\n',
               "game/view/a.cpp": '#include "engine/math/math.hpp"\n' * (most - 3),
               "game/view/b.cpp": "#include <handhold/ecs.hpp>\n"}
        self.assertEqual(breaches(ecs), [])
        ecs["game/view/b.cpp"] += '#include "engine/math/math.hpp"\n'
        self.assertEqual([found.split(":")[0] for found in breaches(ecs)], ["game"])

    def test_circles_of_folders_are_named_with_their_includes(self):
        found = breaches({"engine/math/a.cpp": '#include "engine/core/b.hpp"\n',
                          "engine/core/c.cpp": '\n#include "engine/geometry/d.hpp"\n',
                          "engine/geometry/d.cpp": '#include "engine/math/e.hpp"\n'})
        self.assertEqual(found, ["engine/core/c.cpp:2: circle of folders: engine/core -> engine/geometry -> engine/math -> engine/core"
                                 " (engine/core/c.cpp:2, engine/geometry/d.cpp:1, engine/math/a.cpp:1)"])
        found = breaches({"game/view/a.hpp": '#pragma once\n#include "game/render/b.hpp"\n',
                          "game/render/b.cpp": '#include "game/view/a.hpp"\n',
                          "game/render/c.cpp": '#include "game/mesh/d.hpp"\n'})
        self.assertEqual(found, ["game/render/b.cpp:1: circle of folders: game/render -> game/view -> game/render"
                                 " (game/render/b.cpp:1, game/view/a.hpp:2)"])

    def test_circles_inside_an_area_and_between_areas_are_both_found(self):
        inside = {"engine/solver/model/a.cpp": '#include "engine/solver/sparse/b.hpp"\n',
                  "engine/solver/sparse/b.cpp": '#include "engine/solver/model/a.hpp"\n'}
        self.assertEqual(len(breaches(inside)), 1)
        between = {"engine/solver/model/a.cpp": '#include "engine/anim/b.hpp"\n',
                   "engine/anim/b.cpp": '#include "engine/solver/packed/c.hpp"\n'}
        self.assertEqual(len(breaches(between)), 1)

    def test_chains_and_diamonds_of_folders_are_no_circles(self):
        files = {"game/a/a.cpp": '#include "game/b/b.hpp"\n#include "game/c/c.hpp"\n', "game/b/b.cpp": '#include "game/d/d.hpp"\n',
                 "game/c/c.cpp": '#include "game/d/d.hpp"\n#include "game/c/e.hpp"\n',
                 "game/d/d.cpp": '// #include "game/a/a.hpp"\n'}
        self.assertEqual(breaches(files), [])
        self.assert_clean("tests/game/session/a_test.cpp", '#include "game/desktop/b.hpp"\n')

    def test_only_allowed_files_name_world(self):
        self.assert_breach("systems/physics/a.cpp", "void f(const World& world);\n",
                           "systems/physics/a.cpp:1 | World")
        self.assert_breach("components/grab.hpp", "#pragma once\nstruct World;\n", "components/grab.hpp:2 | World")
        for file in ("systems/frame/frame.cpp", "systems/snapshot/snapshot.cpp", "components/world.cpp", "game/a.cpp",
                     "tests/systems/a.cpp", "tools/lab/a.cpp"):
            self.assert_clean(file, "void f(const World& world);\n")

    def test_world_in_comments_literals_and_longer_names_is_allowed(self):
        self.assert_clean("engine/a.cpp", '// World\n/* the\n World */\nconst char* a = "World"; CollisionWorld b;\n'
                                          'const char* c = R"(\nWorld "quoted")";\n')

    def test_lines_after_block_comments_keep_their_numbers(self):
        self.assert_breach("engine/a.cpp", "/* one\n two\n*/\nWorld w;\n", "engine/a.cpp:4 | World")

    def test_commented_include_is_ignored(self):
        self.assert_clean("engine/a.cpp", '// #include "game/a.hpp"\n/* #include "game/a.hpp" */\n')

    def test_each_library_is_included_in_one_place_only(self):
        homes = {
            "bullet/btBulletCollisionCommon.h": "engine/collision/bullet_collision_world.cpp",
            "btBulletDynamicsCommon.h": "engine/collision/bullet_collision_world.cpp",
            "BulletCollision/CollisionShapes/btConvexShape.h": "engine/collision/bullet_convex.hpp",
            "box2d/b2_distance.h": "engine/geometry/disc_contact_box2d.cpp",
            "oneapi/tbb/parallel_for.h": "engine/core/parallel_pool.cpp",
            "tbb/parallel_for.h": "engine/core/parallel_pool.cpp",
            "draco/compression/decode.h": "engine/io/gltf_draco.cpp",
            "meshoptimizer.h": "engine/geometry/simplify_meshopt.cpp",
            "Eigen/Core": "engine/math/math.hpp",
            "openxr/openxr.h": "game/xr/instance.cpp",
            "SDL2/SDL.h": "game/desktop/window.cpp",
            "epoxy/gl.h": "game/render/renderer.cpp",
        }
        for header, home in homes.items():
            with self.subTest(header=header):
                text = f"#pragma once\n#include <{header}>\n"
                self.assert_clean(home, text)
                self.assert_breach("systems/physics/a.cpp", text, "systems/physics/a.cpp:2 | only ")
                self.assert_clean("tests/engine/a.cpp", text)

    def test_library_types_are_named_in_one_place_only(self):
        for code in ("class btDispatcher;", "b2Vec2 v;", "tbb::task_arena a;", "draco::Mesh m;", "XrSession s;",
                     "SDL_Init(0);", "meshopt_simplify(d);"):
            with self.subTest(code=code):
                self.assert_breach("engine/ecs/a.cpp", code + "\n", "engine/ecs/a.cpp:1 | only")

    def test_own_headers_are_quoted_from_the_root(self):
        self.assert_breach("engine/a.cpp", '#include "b.hpp"\n', "engine/a.cpp:1 | start at the root")
        self.assert_breach("engine/a.cpp", '#include "../components/b.hpp"\n', "engine/a.cpp:1 | start at the root")
        self.assert_breach("engine/a.cpp", "#include <engine/b.hpp>\n", 'engine/a.cpp:1 | our own headers go in ""')
        self.assert_clean("tests/engine/a_test.cpp", '#include "helper_beside_it.hpp"\n')

    def test_header_without_pragma_once_is_named(self):
        self.assert_breach("engine/a.hpp", "// #pragma once\nint a();\n", "engine/a.hpp:1 | no #pragma once")


if __name__ == "__main__":
    unittest.main()
