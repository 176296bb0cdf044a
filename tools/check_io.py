#!/usr/bin/env python3
"""Checks what systems take (CONTRIBUTING.md, "A new stage"). An `Io` is a struct named `<Name>Io`, or one that `using <Name>Io = ...` names.
Prints `file:line: rule` for each breach:
 - a field of an Io does not begin its comment with in, out, in/out or scratch;
 - a header of systems/ names a pointer to a Column;
 - an Io is built without designated initialisers: in a call of its system, as a variable, or returned by a function.

usage: tools/check_io.py [ROOT]      exit status 0: none, 1: some, 2: ROOT has no systems
"""
import re
import sys
from pathlib import Path
from typing import Iterator

from check_includes import without_comments, without_literals

SOURCES = ("systems", "game", "tests", "tools")
MARK = re.compile(r"//\s*(?:in|out|in/out|scratch)\b", re.IGNORECASE)
STRUCT_IO = re.compile(r"\bstruct\s+(\w+Io)\b")
ALIAS_IO = re.compile(r"\busing\s+(\w+Io)\s*=\s*(\w+)\s*;")
SYSTEM = re.compile(r"\b(\w+)\(\s*const\s+(\w+)&\s+io\b")
COLUMN_POINTER = re.compile(r"\bColumn<[^;{}()]*>\s*(?:const\s*)?\*")


def line_of(text: str, offset: int) -> int:
    return text.count("\n", 0, offset) + 1


def end_of_braces(code: str, begin: int) -> int:
    """Offset of the brace that closes the one at `begin`; the end of `code` if none does."""
    depth = 0
    for brace in re.finditer(r"[{}]", code[begin:]):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return begin + brace.start()
    return len(code)


def is_positional(code: str, brace: int) -> bool:
    return re.match(r"\s*[.}]", code[brace + 1 :]) is None


def unmarked_fields(text: str, ios: set[str]) -> Iterator[int]:
    """Offsets of the fields of Ios whose comment, behind or above them, has no mark."""
    bare = without_literals(text)  # of the same length
    for struct in re.finditer(r"\bstruct\s+(\w+)\s*\{", bare):
        if struct[1] not in ios:
            continue
        end = end_of_braces(bare, struct.end() - 1)
        offset = struct.end()
        while (found := re.search(r"[;{]", bare[offset:end])) is not None:
            last = offset + found.start()
            begin = offset + re.match(r"\s*", bare[offset:end]).end()
            if "(" in bare[begin:last] or re.match(r"(struct|enum|private|public|friend|static|using)\b", bare[begin:last]):
                offset = end_of_braces(bare, last) + 1 if found[0] == "{" else last + 1
                continue
            last = last if found[0] == ";" else bare.index(";", end_of_braces(bare, last))
            above = re.search(r"((?:^[ \t]*//[^\n]*\n)+)[ \t]*\Z", text[struct.end() : begin], re.MULTILINE)
            behind = re.match(r"[^\n]*?(//[^\n]*)", text[last:])
            if not any(comment and MARK.match(comment[1].lstrip()) for comment in (behind, above)):
                yield begin
            offset = last + 1


def positional_lists(code: str, ios: set[str], systems: set[str]) -> Iterator[int]:
    """Offsets of the lists that build an Io by position. `code` has no comments and no literals."""
    call = rf"(?<![.>\w])(?:{'|'.join(sorted(systems))})\(\s*(\{{)"
    variable = rf"(?<!struct )\b(?:{'|'.join(sorted(ios))})\b(?:\s+\w+)?\s*=?\s*(\{{)"
    for found in re.finditer(f"{call}|{variable}", code):
        brace = found.start(found.lastindex)
        if is_positional(code, brace):
            yield brace
    for function in re.finditer(rf"\b(?:{'|'.join(sorted(ios))})\s+[\w:]+\([^;{{}}]*\)\s*(?:const\s*)?\{{", code):
        begin = function.end() - 1
        for found in re.finditer(r"\breturn\s*\{", code[begin : end_of_braces(code, begin)]):
            brace = begin + found.end() - 1
            if is_positional(code, brace):
                yield brace


def check_tree(root: Path) -> list[str]:
    headers = {path: path.read_text(encoding="utf-8") for path in sorted((root / "systems").rglob("*.hpp"))}
    ios: set[str] = set()
    systems: set[str] = set()
    for text in headers.values():
        code = without_comments(text)
        ios.update(STRUCT_IO.findall(code))
        ios.update(name for alias in ALIAS_IO.findall(code) for name in alias)
    for text in headers.values():
        systems.update(name for name, io in SYSTEM.findall(without_comments(text)) if io in ios)

    breaches = []
    for path, text in headers.items():
        file = path.relative_to(root).as_posix()
        for offset in unmarked_fields(text, ios):
            breaches.append(f"{file}:{line_of(text, offset)}: a field of an Io says first whether it is in, out, in/out or scratch")
        code = without_comments(text)
        for found in COLUMN_POINTER.finditer(code):
            breaches.append(f"{file}:{line_of(code, found.start())}: a column always exists: take a reference; tests pass an empty column")
    for path in sorted(path for folder in SOURCES for path in (root / folder).rglob("*.[hc]pp")):
        code = without_literals(path.read_text(encoding="utf-8"))
        for brace in positional_lists(code, ios, systems) if ios and systems else ():
            breaches.append(f"{path.relative_to(root).as_posix()}:{line_of(code, brace)}: an Io is built with designated initialisers")
    return breaches


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    if not (root / "systems").is_dir():
        print(f"check_io: {root}: no folder systems/ here", file=sys.stderr)
        return 2
    breaches = check_tree(root)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
