#!/usr/bin/env python3
"""Doxygen's input filter: prints a header with its plain // comments as Doxygen's.

- Lines directly above a declaration document it; above a namespace, the file.
- A comment after a member documents that member, with the lines of comment below it that begin in the same column.
- Everything else, such as a comment with an empty line below it, stays as it is.
"""
import re
import sys
from pathlib import Path

WHOLE_LINE = re.compile(r"(\s*)//(?!/)(.*)")
# After a declaration or an enumerator: not after a brace, where it names what the brace closes.
TRAILING = re.compile(r"(?P<code>\s*[^/\s].*?[\w;,)])(?P<gap>\s+)//(?P<text>(?!/).*)")


def documented(text: str) -> str:
    lines = text.split("\n")
    result = []
    number = 0
    while number < len(lines):
        line = lines[number]
        if WHOLE_LINE.fullmatch(line):
            end = number
            while end < len(lines) and WHOLE_LINE.fullmatch(lines[end]):
                end += 1
            block = lines[number:end]
            declared = lines[end].strip() if end < len(lines) else ""
            if declared and not declared.startswith(("#", "}")):
                block = [WHOLE_LINE.sub(r"\1///\2", comment) for comment in block]
                if declared.startswith("namespace") and result and not result[-1]:
                    result[-1] = r"/// \file"  # in place of the empty line: lines keep their numbers
            result.extend(block)
            number = end
        elif (match := TRAILING.fullmatch(line)) and '"' not in match["code"]:
            result.append(f"{match['code']}{match['gap']}///<{match['text']}")
            column = match.start("text") - 2
            number += 1
            while number < len(lines) and (more := WHOLE_LINE.fullmatch(lines[number])) and len(more[1]) == column:
                result.append(f"{more[1]}///<{more[2]}")
                number += 1
        else:
            result.append(line)
            number += 1
    return "\n".join(result)


if __name__ == "__main__":
    sys.stdout.write(documented(Path(sys.argv[1]).read_text(encoding="utf-8")))
