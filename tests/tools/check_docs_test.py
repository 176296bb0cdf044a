"""Creates one breach of each rule in a small tree and expects check_docs to name it; valid trees give no breach."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "check_docs.py"
spec = importlib.util.spec_from_file_location("check_docs", SCRIPT)
check_docs = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_docs)

TEST_FILE = {"tests/systems/a_test.cpp": "TEST(SolvePhases, HeldRockMovesNobody) {}\n"}

PAGE = "docs/decisions/0001-a.md"
INDEX = "docs/decisions/README.md"


def decisions(first: str, index: str = "| [1](0001-a.md) | One | accepted |\n") -> dict[str, str]:
    """One page, and an index of it and of a second, valid page."""
    return {
        PAGE: first,
        "docs/decisions/0002-b.md": "# 2. Two\nStatus: accepted\n",
        INDEX: index + "| [2](0002-b.md) | Two | accepted |\n",
    }


def breaches(files: dict[str, str]) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_docs.check_tree(root)


class CheckDocs(unittest.TestCase):
    def test_links_that_resolve_are_allowed(self):
        self.assertEqual(breaches({
            "README.md": "[a](docs/a.md) ![b](docs/b.png) [c](docs/a.md#two-words) [d](https://example.org/x) [e](#top)\n# Top\n",
            "docs/a.md": "## Two words\n[up](../README.md)\n",
            "docs/b.png": "",
        }), [])

    def test_broken_link_is_named_with_its_line(self):
        self.assertEqual(breaches({"docs/a.md": "\n[a](b.md)\n"}),
                         ["docs/a.md:2: link to b.md, which does not exist"])

    def test_broken_anchor_is_named(self):
        self.assertEqual(breaches({"a.md": "# Here\n[a](#there)\n"}), ["a.md:2: link to #there: no such heading"])

    def test_links_in_code_are_ignored(self):
        self.assertEqual(breaches({"a.md": "`f[0](x)`\n```\n[a](b.md)\n```\n"}), [])

    def test_maps_name_files_and_tests_that_exist(self):
        self.assertEqual(breaches(TEST_FILE | {
            "docs/talk_map.md": "`tests/systems/a_test.cpp` `SolvePhases.HeldRockMovesNobody` `World` `tests/systems/`\n",
        }), [])

    def test_missing_file_in_a_map_is_named(self):
        self.assertEqual(breaches({"docs/talk_map.md": "`engine/a.cpp`\n"}),
                         ["docs/talk_map.md:1: engine/a.cpp does not exist"])

    def test_missing_test_in_a_map_is_named(self):
        self.assertEqual(breaches(TEST_FILE | {"docs/reference/stages.md": "`SolvePhases.Other`\n"}),
                         ["docs/reference/stages.md:1: no test is called SolvePhases.Other"])

    def test_other_documents_may_name_missing_files(self):
        self.assertEqual(breaches({"CONTRIBUTING.md": "make `systems/grip/new_stage.cpp`\n"}), [])

    def test_guide_names_what_its_files_have(self):
        tree = {
            "systems/a.cpp": "void begin_grab() {}\nvoid drive() {}\n",
            "components/tuning.hpp": 'see("hand.reach_m", t);\n',
            "components/stats.hpp": "std::uint64_t contacts = 0;\n",
            "components/stats.cpp": '{Fallback::grip_lost, "grip_lost"}\n',
        }
        line = "`drive` and `begin_grab` in [a](../../systems/a.cpp), `hand.reach_m`, `hand.cpp`, counters `grip_lost` (3 mm), `contacts`\n"
        self.assertEqual(breaches(tree | {"docs/guide/a.md": line}), [])
        for right, wrong, expected in (("`drive`", "`drives`", "../../systems/a.cpp has no drives"),
                                       ("begin_grab", "begin", "../../systems/a.cpp has no begin"),
                                       ("reach_m", "reach", "no tuning number is called hand.reach"),
                                       ("grip_lost", "grip_gone", "no counter is called grip_gone"),
                                       ("`contacts`", "`contact`", "no counter is called contact")):
            page = {"docs/guide/a.md": line.replace(right, wrong)}
            self.assertEqual(breaches(tree | page), [f"docs/guide/a.md:1: {expected}"])
            self.assertEqual(breaches(tree | {"docs/reference/a.md": line.replace(right, wrong)}), [])

    def test_valid_decisions_are_allowed(self):
        self.assertEqual(breaches(decisions("# 1. One\nStatus: accepted\n" + 13 * (100 * "a" + "\n"))), [])
        for status in ("superseded by 2", "amended by 2"):
            self.assertEqual(breaches(decisions(f"# 1. One\nStatus: {status}\n",
                                                f"| [1](0001-a.md) | One | {status} |\n")), [])

    def test_decision_without_a_status_is_named(self):
        for text in ("# 1. One\n", "# 1. One\n\nStatus: accepted\n", "# 1. One\nStatus: superseded\n"):
            self.assertEqual(breaches(decisions(text)), [
                f"{PAGE}:2: no line `Status: accepted`, `Status: superseded by N` or `Status: amended by N`"])

    def test_decision_that_is_too_long_is_named(self):
        self.assertEqual(breaches(decisions("# 1. One\nStatus: accepted\n" + 14 * "a\n")),
                         [f"{PAGE}:16: more than 15 lines"])

    def test_decision_that_is_too_wide_is_named(self):
        self.assertEqual(breaches(decisions("# 1. One\nStatus: accepted\n\n" + 101 * "a" + "\n")),
                         [f"{PAGE}:4: more than 100 characters"])

    def test_decision_superseded_by_a_missing_one_is_named(self):
        for status in ("superseded by 3", "amended by 2, 3"):
            self.assertEqual(breaches(decisions(f"# 1. One\nStatus: {status}\n",
                                                f"| [1](0001-a.md) | One | {status} |\n")),
                             [f"{PAGE}:2: decision 3 does not exist"])

    def test_decision_superseded_by_an_earlier_one_is_named(self):
        self.assertEqual(breaches(decisions("# 1. One\nStatus: superseded by 1\n",
                                            "| [1](0001-a.md) | One | superseded by 1 |\n")),
                         [f"{PAGE}:2: decision 1 is not later than this one"])

    def test_decision_missing_from_the_index_is_named(self):
        row = "| [1](0001-a.md) | One | accepted |"
        for index in ("", "| [1](0001-a.md) | Another title | accepted |\n", "| [1](0001-a.md) | One | amended by 2 |\n"):
            self.assertEqual(breaches(decisions("# 1. One\nStatus: accepted\n", index)),
                             [f"{PAGE}:1: {INDEX} has no row {row}"])

    def test_decision_with_another_number_in_its_title_is_named(self):
        self.assertEqual(breaches(decisions("# 3. One\nStatus: accepted\n")),
                         [f"{PAGE}:1: the first line is not `# 1. title`"])

    def test_decision_with_a_wrong_file_name_is_named(self):
        self.assertEqual(breaches(decisions("# 1. One\nStatus: accepted\n") | {"docs/decisions/notes.md": ""}),
                         ["docs/decisions/notes.md:1: not called NNNN-short-title.md"])

    def test_two_decisions_with_one_number_are_named(self):
        pages = decisions("# 1. One\nStatus: accepted\n") | {"docs/decisions/0001-c.md": "# 1. Three\nStatus: accepted\n"}
        pages[INDEX] += "| [1](0001-c.md) | Three | accepted |\n"
        self.assertEqual(breaches(pages), [f"{PAGE}:1: another page has number 1",
                                           "docs/decisions/0001-c.md:1: another page has number 1"])

    def test_build_folders_are_ignored(self):
        self.assertEqual(breaches({"build/a.md": "[a](b.md)\n", "out/a.md": "[a](b.md)\n"}), [])


if __name__ == "__main__":
    unittest.main()
