"""Plants one breach of each rule in a small tree and expects check_docs to name it, and nothing where all is well."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "check_docs.py"
spec = importlib.util.spec_from_file_location("check_docs", SCRIPT)
check_docs = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_docs)

TEST_FILE = {"tests/systems/a_test.cpp": "TEST(SolvePhases, HeldRockMovesNobody) {}\n"}


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

    def test_code_is_no_link(self):
        self.assertEqual(breaches({"a.md": "`f[0](x)`\n```\n[a](b.md)\n```\n"}), [])

    def test_maps_name_files_and_tests_that_exist(self):
        self.assertEqual(breaches(TEST_FILE | {
            "docs/talk_map.md": "`tests/systems/a_test.cpp` `SolvePhases.HeldRockMovesNobody` `World` `tests/systems/`\n",
        }), [])

    def test_missing_file_in_a_map_is_named(self):
        self.assertEqual(breaches({"docs/talk_map.md": "`engine/a.cpp`\n"}),
                         ["docs/talk_map.md:1: engine/a.cpp does not exist"])

    def test_missing_test_in_a_map_is_named(self):
        self.assertEqual(breaches(TEST_FILE | {"docs/frame.md": "`SolvePhases.Other`\n"}),
                         ["docs/frame.md:1: no test is called SolvePhases.Other"])

    def test_other_documents_may_name_files_to_be_made(self):
        self.assertEqual(breaches({"CONTRIBUTING.md": "make `systems/grip/new_stage.cpp`\n"}), [])

    def test_build_folders_are_left_out(self):
        self.assertEqual(breaches({"build/a.md": "[a](b.md)\n", "out/a.md": "[a](b.md)\n"}), [])


if __name__ == "__main__":
    unittest.main()
