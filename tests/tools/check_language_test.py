"""Writes words of the former dialect to a small tree and expects check_language to name each, and nothing in plain text or code."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "check_language.py"
spec = importlib.util.spec_from_file_location("check_language", SCRIPT)
check_language = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_language)


def breaches(file: str, text: str) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return check_language.check_tree(Path(folder))


class CheckLanguage(unittest.TestCase):
    def test_each_word_is_found_in_comments_with_its_line(self):
        for words in ("a sunk finger", "closed anew", "the finger has room", "solved in vain", "what is dear", "goes to and fro",
                      "held all the same", "its softness", "the stubborn ones", "bound for it"):
            with self.subTest(words=words):
                found = breaches("engine/a.hpp", f"#pragma once\n// {words}\n")
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith("engine/a.hpp:2: "), found)

    def test_words_are_found_in_block_comments_messages_documents_and_scripts(self):
        self.assertEqual(len(breaches("game/a.cpp", "/* one\n sunk */\n")), 1)
        self.assertEqual(len(breaches("game/a.cpp", 'print("the hand is sunk");\n')), 1)
        self.assertEqual(len(breaches("docs/a.md", "Solved anew.\n")), 1)
        self.assertEqual(len(breaches("tools/a.py", "# solved anew\n")), 1)
        self.assertEqual(len(breaches("tools/a.py", '"""One.\n\nSolved anew.\n"""\n')), 1)

    def test_forbidden_sentence_opening_is_found(self):
        self.assertEqual(len(breaches("engine/a.cpp", "// What is clear stays.\n")), 1)
        self.assertEqual(len(breaches("engine/a.cpp", "// Sorted. Of those two the first.\n")), 1)

    def test_trailing_comments_that_begin_with_a_preposition_or_pronoun_are_found(self):
        for words in ("of the frame", "by HandSide", "in [0, 1]", "at most 3", "its index", "without tremor"):
            with self.subTest(words=words):
                found = breaches("engine/a.hpp", f"#pragma once\nint a = 0;  // {words}\n")
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith("engine/a.hpp:2: "), found)
                self.assertEqual(breaches("tests/a.cpp", f"int a = 0;  // {words}\n"), [])

    def test_nouns_sentences_and_marks_of_inputs_are_clean(self):
        for words in ("index of the frame", "one per hand", "in", "in: world, m", "in/out", "in (play space)", "the hand closes where it is"):
            with self.subTest(words=words):
                self.assertEqual(breaches("engine/a.hpp", f"#pragma once\nint a = 0;  // {words}\n"), [])
        self.assertEqual(breaches("engine/a.hpp", "// of a whole comment line\nint a = 0;\n"), [])

    def test_plain_text_identifiers_and_contract_keys_are_clean(self):
        self.assertEqual(breaches("engine/a.cpp", '// Re-solves the finger from scratch.\nint sunk = 0;\nadd("sunk_m");\n'), [])
        self.assertEqual(breaches("docs/a.md", "The field `sunk_m` is gone; there is no room for doubt.\n"), [])


if __name__ == "__main__":
    unittest.main()
