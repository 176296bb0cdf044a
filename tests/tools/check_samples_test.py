"""Creates one breach of each rule in a small tree and expects check_samples to name it; valid trees give no breach."""
import tempfile
import unittest
from pathlib import Path

from planted import plant  # first: makes tools/ importable

import check_samples

PROGRAM = """int main() {
    // [world]
    World world;
    // [step]
    if (world.steps()) {
        step(world);
    }
    // [step]
    // [world]
}
"""
STEP = "if (world.steps()) {\n    step(world);\n}\n"
LINE = "<!-- sample: tests/samples/hello.cpp#step -->"


def page(text: str, line: str = LINE) -> str:
    return f"# Hello\n\n{line}\n```cpp\n{text}```\n"


class CheckSamples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def breaches(self, files: dict[str, str], fix: bool = False) -> list[str]:
        plant(self.root, files)
        return check_samples.check_tree(self.root, fix)

    def breaches_of(self, text: str) -> list[str]:
        return self.breaches({"docs/a.md": text, "tests/samples/hello.cpp": PROGRAM})

    def test_region_is_shown_without_its_indentation(self):
        self.assertEqual(self.breaches_of(page(STEP)), [])

    def test_markers_of_inner_regions_are_not_shown(self):
        self.assertEqual(self.breaches_of(page("World world;\n" + STEP, LINE.replace("step", "world"))), [])

    def test_changed_line_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP.replace("step(", "stop("))),
                         ["docs/a.md:6: not as in tests/samples/hello.cpp#step, which has `    step(world);`"])

    def test_missing_line_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP.removesuffix("}\n"))),
                         ["docs/a.md:7: not as in tests/samples/hello.cpp#step, which has `}`"])

    def test_extra_line_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP + "done();\n")),
                         ["docs/a.md:8: not as in tests/samples/hello.cpp#step, which has the end of the region"])

    def test_sample_without_a_program_is_named(self):
        self.assertEqual(self.breaches_of("```cpp\nstep(world);\n```\n"),
                         ["docs/a.md:1: a C++ fence without a line `<!-- sample: FILE#REGION -->` before it"])

    def test_missing_program_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP, LINE.replace("hello", "bye"))),
                         ["docs/a.md:3: tests/samples/bye.cpp does not exist"])

    def test_program_outside_the_samples_folder_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP, LINE.replace("tests/samples", "docs"))),
                         ["docs/a.md:3: docs/hello.cpp is not a program in tests/samples/"])

    def test_missing_region_is_named(self):
        self.assertEqual(self.breaches_of(page(STEP, LINE.replace("step", "stop"))),
                         ["docs/a.md:3: tests/samples/hello.cpp has 0 lines `// [stop]`, expected 2"])

    def test_marker_not_directly_before_a_fence_is_named(self):
        self.assertEqual(self.breaches_of(f"{LINE}\n\n```\n```\n"),
                         ["docs/a.md:1: expected `<!-- sample: FILE#REGION -->` directly before a fence"])

    def test_malformed_marker_is_named(self):
        self.assertEqual(self.breaches_of("<!-- sample: tests/samples/hello.cpp -->\n```text\n```\n"),
                         ["docs/a.md:1: expected `<!-- sample: FILE#REGION -->` directly before a fence"])

    def test_other_languages_and_fences_within_fences_need_no_program(self):
        self.assertEqual(self.breaches_of(f"```json\n{{}}\n```\n````text\n{page(STEP, '')}````\n"), [])

    def test_build_folders_are_ignored(self):
        self.assertEqual(self.breaches({"build/a.md": page(STEP)}), [])

    def test_fix_copies_the_regions_and_nothing_else(self):
        text = page("", LINE.replace("step", "world")) + "Between.\n" + page("old();\n") + "After.\n"
        files = {"docs/a.md": text, "tests/samples/hello.cpp": PROGRAM}
        self.assertEqual(self.breaches(files, fix=True), [])
        self.assertEqual((self.root / "docs/a.md").read_text(encoding="utf-8"),
                         page("World world;\n" + STEP, LINE.replace("step", "world")) + "Between.\n" + page(STEP) + "After.\n")
        self.assertEqual(check_samples.check_tree(self.root), [])


if __name__ == "__main__":
    unittest.main()
