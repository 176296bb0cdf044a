#!/usr/bin/env python3
"""Refuses words of the project's former dialect in comments, string literals and documents (docs/reference/glossary.md has the terms to use).
Prints `file:line: word: use ...` for each. Refuses trailing comments of C++ code, except in tests, that begin with a preposition or a pronoun:
such a fragment makes its reader guess what it speaks of.

usage: tools/check_language.py [ROOT]      exit status 0: none, 1: some
"""
import re
import sys
from pathlib import Path
from typing import Iterator

CODE_FOLDERS = ("engine", "components", "systems", "game", "tests", "tools")
CODE_ENDINGS = {".cpp", ".hpp", ".h", ".py", ".cmake"}
# Files that must name the words: this one, its test and the glossary.
EXEMPT = {"tools/check_language.py", "tests/tools/check_language_test.py", "docs/reference/glossary.md"}
NOT_OURS = {"build", "out", ".git"}

# Pattern, in lower case -> what to write instead.
WORDS = [
    (r"sunk|sinks? into|is sinking", "penetrating, penetration depth"),
    (r"anew|afresh", "again, from scratch, re-"),
    (r"(?:has|have|had|no|have no) room\b(?! for| in)", "clearance"),
    (r"judged?\b(?! by)", "evaluate"),
    (r"is tried|are tried|tried and", "tested, evaluated"),
    (r"unsettled|settled", "converged, at target"),
    (r"has arrived|have arrived", "is at its target"),
    (r"led hands|lead hands|hands are led|led part by part", "load stepping"),
    (r"softness|softest|softens?|softened|hardens|hardened|hardening", "regularisation"),
    (r"mends?|mended|mending", "fix, depenetrate"),
    (r"outlook", "look-ahead, cached result"),
    (r"dear(?! imgui)|dearer|dearest", "expensive"),
    (r"in vain", "failed, without success"),
    (r"bound for", "target"),
    (r"at ease|relaxed pose", "rest pose"),
    (r"strolls?", "describe the movement"),
    (r"put back|puts back|goes back to where|went back to where", "restored to the last valid pose"),
    (r"stubborn|busy rows", "unresolved contacts, active rows"),
    (r"gone through|comes into|come into", "crosses, enters"),
    (r"hangs? together", "connected bodies, island"),
    (r"things?", "bodies, or name them"),
    (r"to and fro", "back and forth; oscillates"),
    (r"no wonder|all the same|nobody else's matter|a hand's matter", "(delete)"),
    (r"undecided", "not converged"),
]
RULES = [(re.compile(rf"\b(?:{pattern})\b", re.IGNORECASE), instead) for pattern, instead in WORDS]
# Openings of sentences that are hard to read.
OPENINGS = re.compile(r"(?:^\W*|[.:;] )((?:What is|Of those|Where that) [a-z])")

# A trailing comment is a noun or a sentence. The words "in" and "in/out" are the marks of a system's inputs and outputs.
FRAGMENT = re.compile(
    r"^.*[^\s/].*?\s//\s(?P<first>of|by|in|as|it|its|at|on|for|from|to|with|without|after|before|until|into|per|within|this|these|those|that"
    r"|which|their|they|between|against|under|over|along|across|through|beside|behind|above|below|about|around|near)\b(?P<rest>.*)$")
DIRECTION = re.compile(r"(?:/out)?(?:$|[,:;]| \()")

CPP_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
CPP_CODE_LITERAL = re.compile(r"^\"[\w.:/#%@-]*\"$")  # a key, a path, a format: no prose
PY_TEXT = re.compile(r'"""(?:.*?)"""|#[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def prose_of(path: Path, text: str) -> Iterator[tuple[int, str]]:
    """Line number and text of each line of prose."""
    if path.suffix == ".md":
        yield from enumerate(text.split("\n"), start=1)
        return
    pattern = PY_TEXT if path.suffix in {".py", ".cmake"} else CPP_TEXT
    for found in pattern.finditer(text):
        if CPP_CODE_LITERAL.match(found[0]):
            continue
        first = text.count("\n", 0, found.start()) + 1
        yield from enumerate(found[0].split("\n"), start=first)


def fragments_of(file: str, text: str) -> Iterator[str]:
    for number, line in enumerate(text.split("\n"), start=1):
        found = FRAGMENT.match(line)
        if found and not (found["first"] == "in" and DIRECTION.match(found["rest"])):
            yield f'{file}:{number}: "{found["first"]}{found["rest"]}": begin a trailing comment with a noun, or write a sentence'


def breaches_of(file: str, path: Path, text: str) -> Iterator[str]:
    if path.suffix in {".cpp", ".hpp", ".h"} and not file.startswith("tests/"):
        yield from fragments_of(file, text)
    for number, line in prose_of(path, text):
        bare = re.sub(r"`[^`]*`", "``", line)
        for rule, instead in RULES:
            for found in rule.finditer(bare):
                yield f"{file}:{number}: {found[0]}: use {instead}"
        for found in OPENINGS.finditer(bare):
            yield f'{file}:{number}: "{found[1]}": say who does what'


def files_of(root: Path) -> Iterator[Path]:
    for folder in CODE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and (path.suffix in CODE_ENDINGS or path.name == "CMakeLists.txt"):
                yield path
    for path in sorted(root.rglob("*.md")):
        if path.relative_to(root).parts[0] not in NOT_OURS:
            yield path


def check_tree(root: Path) -> list[str]:
    breaches = []
    for path in files_of(root):
        file = path.relative_to(root).as_posix()
        if file not in EXEMPT:
            breaches.extend(breaches_of(file, path, path.read_text(encoding="utf-8")))
    return breaches


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    breaches = check_tree(root)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
