#!/usr/bin/env python3
"""Doxygen's input filter: prints a header with its plain // comments converted to Doxygen's.

- Lines directly above a declaration document it; above a namespace, the file.
- A comment after a member documents that member, including comment lines below that start in the same column.
- All other comments, such as one followed by an empty line, are unchanged.
"""
import re
import sys
from pathlib import Path

WHOLE_LINE = re.compile(r"(\s*)//(?!/)(.*)")
# After a declaration or an enumerator, but not after a brace, where the comment names the closed block.
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
                    result[-1] = r"/// \file"  # replaces the empty line, so line numbers stay
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
