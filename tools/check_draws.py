#!/usr/bin/env python3
"""Checks that tests draw random numbers in an order that C++ defines, so that every compiler builds the same inputs. Prints
`file:line: text` for each expression of which two arguments or operands draw: their order is left to the compiler. Elements of a braced
list are ordered. A draw is a call of a generator's member, or a call that is given a generator; calls of a lambda that draws are not seen.

usage: tools/check_draws.py [ROOT]      exit status 0: none, 1: some, 2: ROOT has no tests
"""
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

from check_includes import without_literals

GENERATOR = re.compile(r"\bRandom&?\s+(\w+)")
BLOCK_FOLLOWS = re.compile(r"(?:[;{})\]]|\b(?:else|do|try|const|override|noexcept))\s*$")


@dataclass
class Bracket:
    sign: str
    arguments_of_draw: bool = False  # these are drawn before it
    draws: bool = False  # anything within the brackets
    operands: int = 0  # that draw, in the expression so far
    arguments: int = 0  # that draw, before this one
    argument_draws: bool = False


def tokens(code: str) -> Iterator[re.Match]:
    """Draws, generators that a call is given, brackets, and the signs that order what stands before and after them."""
    names = "|".join(sorted(set(GENERATOR.findall(code)) | {"random"}))
    return re.finditer(
        rf"(?P<draw>\b(?:{names})\.\w+\()|(?P<given>\b(?:{names})\b(?=\s*[,)]))|(?P<open>[(\[{{])|(?P<close>[)\]}}])"
        r"|(?P<order>;|&&|\|\||\?|(?<!:):(?!:)|<<|(?<![=<>!])=(?!=))|(?P<comma>,)", code)


def breaches(code: str) -> Iterator[int]:
    """Offsets at which the second operand or argument that draws begins or ends."""
    stack = [Bracket("block")]

    def draw(offset: int) -> Iterator[int]:
        top = stack[-1]
        top.draws = top.argument_draws = True
        top.operands += 1
        if top.operands == 2 or (top.operands == 1 and top.arguments > 0):
            yield offset

    for token in tokens(code):
        top = stack[-1]
        if token["draw"]:
            yield from draw(token.start())
            stack.append(Bracket("(", arguments_of_draw=True))
        elif token["given"]:
            top.draws = True
        elif token["open"]:
            before = code[max(0, token.start() - 12) : token.start()].rstrip()
            is_block = token["open"] == "{" and BLOCK_FOLLOWS.search(before) and not (before[-1] == "{" and top.sign == "{")
            if is_block:
                top.operands = 0
            stack.append(Bracket("block" if is_block else token["open"]))
        elif token["close"] and len(stack) > 1:
            closed = stack.pop()
            if closed.draws and closed.sign != "block" and not closed.arguments_of_draw:
                yield from draw(token.start())
        elif token["comma"] and top.sign == "(":
            top.arguments += top.argument_draws
            top.operands, top.argument_draws = 0, False
        elif token["order"] or token["comma"]:
            top.operands = 0
            if token["order"] == ";":  # of a loop's header
                top.arguments, top.argument_draws = 0, False


def main() -> int:
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    paths = sorted([*(root / "tests").rglob("*.cpp"), *(root / "tests").rglob("*.hpp")])
    if not paths:
        print(f"{root}: no tests", file=sys.stderr)
        return 2
    found = 0
    for path in paths:
        text = path.read_text(encoding="utf-8")
        for offset in breaches(without_literals(text)):
            line = text.count("\n", 0, offset) + 1
            print(f"{path.relative_to(root)}:{line}: {text.splitlines()[line - 1].strip()}")
            found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
