"""Plants one untrue contract of each kind in a small tree and expects check_contracts to name it; true contracts give no breach."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "check_contracts.py"
spec = importlib.util.spec_from_file_location("check_contracts", SCRIPT)
check_contracts = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_contracts)

TUNING = """#pragma once
struct HandTuning {
    double reach_m = 0.12;
    double max_stretch_m = 0.3;
};
struct Tuning {
    HandTuning hand;
};
"""


def breaches(files: dict[str, str]) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in {"components/tuning.hpp": TUNING, **files}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return [str(breach) for breach in check_contracts.check_tree(root)]


class CheckContracts(unittest.TestCase):
    def assert_breach(self, text: str, line: int, words: str, others: dict[str, str] | None = None):
        found = breaches({"systems/a.hpp": text, **(others or {})})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"systems/a.hpp:{line}: {words}"), found)

    def assert_clean(self, text: str, others: dict[str, str] | None = None):
        self.assertEqual(breaches({"systems/a.hpp": text, **(others or {})}), [])

    def test_number_without_a_constant_is_named_with_its_line(self):
        self.assert_breach("// Closes again on another body, and\n// after 3 cm of travel.\nvoid f();\n", 2, "3 cm: ")
        self.assert_breach("struct A {\n    double dt;  // at most 0.5 s\n};\n", 2, "0.5 s: ")

    def test_number_that_differs_from_the_constant_of_its_sentence_is_named(self):
        constant = "inline constexpr double k_again_m = 0.08;\n"
        self.assert_breach(constant + "// After k_again_m (3 cm) of travel.\nvoid f();\n", 2, "3 cm: ")
        self.assert_clean(constant + "// After k_again_m (8 cm) of travel.\nvoid f();\n")
        self.assert_clean(constant + "// After k_again_m of travel.\nvoid f();\n")

    def test_constant_of_another_sentence_does_not_count(self):
        constant = "inline constexpr double k_again_m = 0.08;\n"
        self.assert_breach(constant + "// After k_again_m of travel. Rests after 8 cm more.\nvoid f();\n", 2, "8 cm: ")

    def test_comment_beside_a_constant_gives_its_value_in_any_unit(self):
        self.assert_clean("inline constexpr double k_a_rad = 1.0471975511965976;  // 60 degrees\n")
        self.assert_clean("inline constexpr double k_a_rad = 2.0 / 3.0 * k_pi;  // 120 degrees\n")
        self.assert_clean("inline constexpr double k_wide_mm = 30.0;  // 3 cm\n")
        self.assert_clean("inline constexpr double k_share = 0.75;  // 75 %\n")
        self.assert_clean("inline constexpr double k_half_s = 0.5;\ninline constexpr double k_s = 2.0 * k_half_s;  // 1 s\n")
        self.assert_breach("inline constexpr double k_a_rad = 1.0471975511965976;  // 50 degrees\n", 1, "50 degrees: ")

    def test_constants_of_included_headers_count(self):
        others = {"engine/b.hpp": '#include "engine/c.hpp"\n', "engine/c.hpp": "constexpr double k_far_m = 2.0;\n"}
        self.assert_clean('#include "engine/b.hpp"\n// At most k_far_m, 2 m.\nvoid f();\n', others)
        self.assert_breach('#include "engine/b.hpp"\n// At most k_far_m, 3 m.\nvoid f();\n', 2, "3 m: ", others)

    def test_names_that_no_header_has_are_named(self):
        self.assert_breach("// At most k_gone_m.\nvoid f();\n", 1, "k_gone_m: no header")
        self.assert_breach("// At most HandTuning::gone_m.\nvoid f();\n", 1, "HandTuning::gone_m: no such number")
        self.assert_breach("// At most hand.gone_m.\nvoid f();\n", 1, "hand.gone_m: no such number")
        self.assert_clean("// At most HandTuning::reach_m, and hand.max_stretch_m. The axis is hand.up, see hand.hpp.\nvoid f();\n")

    def test_defaults_of_the_tuning_count(self):
        self.assert_clean("// Within HandTuning::reach_m (12 cm by default).\nvoid f();\n")
        self.assert_breach("// Within hand.reach_m (10 cm by default).\nvoid f();\n", 1, "10 cm: ")

    def test_examples_costs_measurements_and_accuracies_are_allowed(self):
        for sentence in ("For example, 3 m.", "Parts such as a rod of 3 m.", "Costs about 3 us.", "It was measured to be 3 mm off.",
                         "The error is below 3 mm."):
            self.assert_clean(f"// {sentence}\nvoid f();\n")
        self.assert_breach("// Costs about 3 us. At most 3 m.\nvoid f();\n", 1, "3 m: ")

    def test_numbers_without_a_unit_fractions_and_names_are_ignored(self):
        self.assert_clean("// Talk rows 12 to 15, decision 5. In steps of 1/120 s; 3 degrees of freedom; a 3D point; v 2 N_i; 2 members.\nvoid f();\n")
        self.assert_clean('constexpr const char* k_text = "3 m // 4 m";\n')

    def test_generated_headers_and_sources_are_not_compared(self):
        self.assert_clean("// Written by tools/lab/fit; do not edit.\n// Chest, 9.4 degrees.\n")
        self.assertEqual(breaches({"systems/a.cpp": "// 3 cm\n", "game/a.hpp": "// 3 cm\n"}), [])
        self.assertEqual(len(breaches({"engine/a.hpp": "// 3 cm\n"})), 1)


if __name__ == "__main__":
    unittest.main()
