"""What the generator makes of headers: purposes of pointers, errors for unclear ones, and wrappers that keep their objects."""
import re
import sys
import tempfile
import unittest
from pathlib import Path

BINDINGS = Path(__file__).resolve().parent.parent.parent / "systems/host/bindings"
sys.path.insert(0, str(BINDINGS))
import read_headers  # noqa: E402

PLANTED = """
#define HH_LEG_COUNT 2 /* of a person */
#define HH_NO_LEG 0xffffffffu
typedef enum hh_result { HH_OK = 0 } hh_result;
typedef struct hh_leg { double length_m; } hh_leg;
/* DOC */
HH_API hh_result hh_walk(PARAMETERS);
"""


def planted(doc: str, parameters: str) -> read_headers.Description:
    description = read_headers.Description()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "planted.h"
        path.write_text(PLANTED.replace("DOC", doc).replace("PARAMETERS", parameters), encoding="utf-8")
        read_headers.Reader(read_headers.tokens_of(path, description.constants), description).read()
    read_headers.Purposes(description).add()
    return description


def roles(doc: str, parameters: str) -> list:
    description = planted(doc, parameters)
    return [(one["role"], one["length"]) if "length" in one else one["role"] for one in description.functions[0]["params"]]


class Generator(unittest.TestCase):
    def test_comments_say_what_const_pointers_are(self):
        for doc, role in (("`legs`: HH_LEG_COUNT elements.", ("array", 2)), ("Null: stands.", "optional"), ("`legs`, not null.", "required")):
            self.assertEqual(roles(doc, "const hh_leg* legs"), [role])

    def test_a_count_belongs_to_the_parameter_that_it_names(self):
        both = "const hh_leg* from, hh_leg* to"
        self.assertEqual(roles("`from`: HH_LEG_COUNT elements.", both), [("array", 2), "out"])
        self.assertEqual(roles("`from`: HH_LEG_COUNT elements. `to`: HH_LEG_COUNT elements.", both), [("array", 2), ("out_array", 2)])

    def test_numbers_of_macros(self):
        self.assertEqual(planted("Walks.", "double pace_m").constants, [{"name": "HH_LEG_COUNT", "value": 2}, {"name": "HH_NO_LEG", "value": 2**32 - 1}])

    def test_unclear_pointers_are_errors(self):
        for doc in ("Walks.", "HH_LEG_COUNT elements.", "`arms`: HH_LEG_COUNT elements.", "`legs`: HH_ARM_COUNT elements."):
            with self.assertRaises(read_headers.HeaderError, msg=doc):
                roles(doc, "const hh_leg* legs")

    def test_pointers_of_the_interface(self):
        description = read_headers.read(BINDINGS.parent / "include")
        found = {(function["name"], one["name"]): (one["role"], one.get("length")) for function in description.functions for one in function["params"]
                 if one.get("role") in ("optional", "required") or "length" in one}
        definitions = {key for key in found if key[1] == "def"}
        self.assertEqual({key: what for key, what in found.items() if key not in definitions}, {
            ("hh_set_host_hooks", "hooks"): ("optional", None),
            ("hh_player_set_measures", "measures"): ("required", None),
            ("hh_player_set_hand_in_controller", "hand_in_controller"): ("optional", None),
            ("hh_finger_curls_of", "joints"): ("array", 26),
            ("hh_player_hand_joints", "joints"): ("out_array", 26),
            ("hh_player_body_joints", "joints"): ("out_array", 20),
            ("hh_world_set_surface_query", "query"): ("optional", None),
            ("hh_hand_hold", "anchor"): ("optional", None),
            ("hh_match_create", "game"): ("optional", None),
            ("hh_match_advance", "input"): ("required", None),
            ("hh_match_drawn_player", "newest"): ("optional", None),
        })

    def test_every_call_in_csharp_keeps_its_objects(self):
        text = (BINDINGS / "csharp/Handhold.g.cs").read_text(encoding="utf-8")
        methods = re.findall(r"\n        public unsafe .*?\n        }", text.partition("public partial class World")[2], re.DOTALL)
        self.assertGreater(len(methods), 100)
        for method in methods:
            for used in {"this"} | set(re.findall(r"(\w+)\.Handle\b", method)):
                self.assertIn(f"GC.KeepAlive({used});", method)

    def test_every_function_of_a_match_is_a_method(self):
        description = read_headers.read(BINDINGS.parent / "include")
        functions = [one["name"] for one in description.functions if one["name"].startswith("hh_match_")]
        self.assertGreater(len(functions), 20)
        made_by_hand = {"hh_match_create", "hh_match_destroy"}
        for path, start in (("csharp/Handhold.g.cs", "public partial class Match {"), ("python/handhold/_generated.py", "class MatchCalls:")):
            methods = (BINDINGS / path).read_text(encoding="utf-8").partition(start)[2]
            self.assertEqual([name for name in functions if name not in made_by_hand and f"{name}(" not in methods], [], path)


if __name__ == "__main__":
    unittest.main(verbosity=0)
