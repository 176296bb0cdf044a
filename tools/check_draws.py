#!/usr/bin/env python3
"""Checks that tests draw random numbers in an order that C++ defines, so that every compiler builds the same inputs. Prints
`file:line: call` for each call with draws in more than one argument; elements of a braced list are ordered, arguments are not.

usage: tools/check_draws.py [ROOT]      exit status 0: none, 1: some
"""
import re
import sys
from pathlib import Path
from typing import Iterator

from check_includes import without_comments, without_literals

GENERATOR = re.compile(r"\bRandom&?\s+(\w+)")
STATEMENT = re.compile(r"\b(?:for|if|while|switch)\s*$")


def calls(code: str) -> Iterator[tuple[int, list[str]]]:
    """Each pair of parentheses with a comma: its offset and the text between the commas."""
    open_brackets: list[tuple[str, int, list[int]]] = []
    for i, sign in enumerate(code):
        if sign in "([{":
            open_brackets.append((sign, i, [i]))
        elif sign == "," and open_brackets:
            open_brackets[-1][2].append(i)
        elif sign in ")]}" and open_brackets:
            bracket, begin, separators = open_brackets.pop()
            if bracket == "(" and len(separators) > 1 and not STATEMENT.search(code[max(0, begin - 8) : begin]):
                ends = separators[1:] + [i]
                yield begin, [code[a + 1 : b] for a, b in zip(separators, ends)]


def breaches(code: str) -> Iterator[int]:
    """Offsets of the calls with draws in more than one argument."""
    names = "|".join(sorted(set(GENERATOR.findall(code)) | {"random"}))
    # A member function of a generator, or a helper that is given the generator last.
    draw = re.compile(rf"\b(?:{names})\.(?!engine\b)\w+\(|[(,]\s*(?:{names})\)")
    for begin, arguments in calls(code):
        if sum(draw.search(argument) is not None for argument in arguments) > 1:
            yield begin


def main() -> int:
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = 0
    for path in sorted([*(root / "tests").rglob("*.cpp"), *(root / "tests").rglob("*.hpp")]):
        text = path.read_text()
        for begin in breaches(without_literals(without_comments(text))):
            line = text.count("\n", 0, begin) + 1
            print(f"{path.relative_to(root)}:{line}: {text.splitlines()[line - 1].strip()}")
            found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
