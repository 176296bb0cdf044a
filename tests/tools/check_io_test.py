"""Plants one breach of each rule in a small tree and expects check_io to name it; what the rules allow gives no breach."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_io  # noqa: E402

HEADER = """
struct MoveHandsIo {
    double dt_s;                 // in: > 0
    const Column<Hand>& hand;    // in; out: none {of them}
    // In/out: a comment
    // of two lines.
    std::span<std::array<Trace, 5>> traces;
    Column<Palm>& palm;          // out
    Scratch& scratch;            // scratch
    SurfaceQuery surfaces = {};  // in

    double half_s() const { return 0.5 * dt_s; }
};
void move_hands(const MoveHandsIo& io, const Tuning& tuning);
struct Search {
    const Column<Hand>& hand;  // in
};
using FindGripIo = Search;
void find_grip(const FindGripIo& io);
"""


def breaches(files: dict[str, str]) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in {"systems/hand/move_hands.hpp": HEADER, **files}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_io.check_tree(root)


class CheckIo(unittest.TestCase):
    def assert_one(self, found: list[str], place: str, words: str):
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"{place}: "), found)
        self.assertIn(words, found[0])

    def test_positional_lists_are_found_wherever_an_io_is_built(self):
        for code in ("move_hands({0.1, hand}, tuning);", "handhold::move_hands(\n{f.dt_s(), hand}, tuning);", "find_grip({hand});",
                     "const MoveHandsIo io{0.1, hand};", "const MoveHandsIo io = {0.1, hand};", "run(Search{hand});",
                     "FindGripIo io{hand};", "Search search(const World& w) {\n    if (w.a) { b(); }\n    return {w.hand};\n}",
                     "move_hands({x.dt_s, .hand = hand}, tuning);", "move_hands({/* .dt_s = */ 0.1, hand}, tuning);"):
            for file in ("systems/frame/frame.cpp", "tests/systems/hand/a_test.cpp", "game/view/a.hpp", "tools/lab/a.cpp"):
                with self.subTest(code=code, file=file):
                    line = 1 + code.count("\n", 0, code.rindex("{"))
                    self.assert_one(breaches({file: code}), f"{file}:{line}", "designated")

    def test_designated_lists_and_other_calls_are_clean(self):
        for code in ("move_hands({.dt_s = 0.1, .hand = hand}, tuning);", "move_hands({\n    // why\n    .dt_s = 0.1}, tuning);",
                     "const MoveHandsIo io{.dt_s = 0.1};", "world.find_grip({0.1, 0.2});", "world->find_grip({0.1});",
                     "void find_grip(const FrameContext& f) {\n    return;\n}", "find_grip(search);", "x = 1; // find_grip({hand})",
                     'log("find_grip({hand})");', "struct Search;", "may_find_grip({hand});", "Search s{};",
                     "Search search(const World& w) { return {.hand = w.hand}; }"):
            with self.subTest(code=code):
                self.assertEqual(breaches({"systems/frame/frame.cpp": code}), [])

    def test_pointers_to_columns_are_found(self):
        for field in ("const Column<Hand>* hand = nullptr;  // in", "Column<Hand> * hand;  // in",
                      "const Column<std::pair<A, B>>* const hand;  // in"):
            with self.subTest(field=field):
                text = f"struct Rules {{\n    {field}\n}};\n"
                self.assert_one(breaches({"systems/grab/rules.hpp": text}), "systems/grab/rules.hpp:2", "column")
        self.assertEqual(breaches({"systems/grab/rules.hpp": "struct Rules {\n    const Library* none;  // Column<A>* is not\n};\n"}), [])

    def test_fields_without_their_direction_are_found(self):
        for field in ("Column<Hand>& hand;", "Column<Hand>& hand;  // written", "// The hand.\n    Column<Hand>& hand;",
                      "Column<Hand>& hand;  // inner", "double dt_s = 0.0;  // seconds", "Rules rules{};"):
            with self.subTest(field=field):
                text = f"struct GripIo {{\n    double t_s;  // in\n    {field}\n    Column<A>& a;  // out\n}};\n"
                line = 3 + field.count("\n")
                self.assert_one(breaches({"systems/grab/grip.hpp": text}), f"systems/grab/grip.hpp:{line}", "in/out")

    def test_comment_behind_the_field_above_is_not_this_fields(self):
        text = "struct GripIo {\n    double t_s;  // in\n    double dt_s;\n};\n"
        self.assert_one(breaches({"systems/grab/grip.hpp": text}), "systems/grab/grip.hpp:3", "in/out")

    def test_tree_without_systems_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(check_io.main([folder]), 2)


if __name__ == "__main__":
    unittest.main()
