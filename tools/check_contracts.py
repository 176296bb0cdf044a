#!/usr/bin/env python3
"""Compares the contracts in the headers of engine/ and systems/ with the constants that they name. Prints `file:line: what differs` for each.

Contracts are the // comments of *.hpp. A sentence of one may use:

- `k_name`: a constant with this name is in the header, in one that it includes, or in another header of engine/, components/ or systems/.
- `SomeTuning::field` and `group.field`: this number is in the tuning (components/*tuning.hpp).
- a number with a unit of length, time, angle, mass, force, speed or frequency, if one of these holds:
    - a constant that the sentence names, or whose declaration the comment stands beside, has this value in this unit (30 mm: 0.03);
    - the sentence names a field of the tuning whose default has this value;
    - the sentence says what kind of number it is: an example ("for example", "for instance", "such as"), a measurement ("measured"), a
      cost ("cost", "costs"), or an accuracy ("error").
  Fractions (1/90 s), numbers without a unit, and comments of generated headers are not compared.

The way to pass is to name the constant and leave its value to its declaration: "at most k_head_eject_mps", not "3 m/s".

usage: tools/check_contracts.py [ROOT]      exit status 0: none, 1: some
"""
import ast
import math
import operator
import re
import sys
from pathlib import Path
from typing import Iterator, NamedTuple

FOLDERS = ("engine", "systems")
GENERATED = re.compile(r"// .*Written by tools/.*do not edit")
TUNING = ("components/tuning.hpp", "components/body_tuning.hpp")

UNITS = {"km": 1e3, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0,
         "rad": 1.0, "degrees": math.pi / 180.0, "degree": math.pi / 180.0, "deg": math.pi / 180.0, "kg": 1.0, "g": 1e-3, "N": 1.0,
         "Hz": 1.0, "m/s": 1.0, "km/h": 1.0 / 3.6, "m/s^2": 1.0, "rad/s": 1.0, "%": 1e-2}
# The unit in a constant's name -> the unit of its value. Other names have SI units, or none.
SUFFIXES = {"_mm": "mm", "_us": "us", "_ns": "ns", "_ms": "ms", "_deg": "degrees"}
NUMBER = re.compile(r"(?<![\w./^-])(?P<number>\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?:-| )?(?P<unit>" +
                    "|".join(sorted(map(re.escape, UNITS), key=len, reverse=True)) + r")(?![\w/^]|\.\w)")
NOT_ANGLES = re.compile(r"degrees? of freedom")
# Words that say what kind of number a sentence states.
KINDS = re.compile(r"\b(for example|for instance|such as|measured|costs?|errors?)\b", re.IGNORECASE)

CONSTANT_NAME = re.compile(r"\bk_[a-z0-9_]*[a-z0-9]\b(?!\*)")
TUNING_FIELD = re.compile(r"\b(\w+Tuning)::(\w+)")
DECLARATION = re.compile(r"\bconstexpr\s+[\w:<>, ]+?[ &*](k_\w+)\s*(?:=|\{)\s*([^;]*?)\}?;", re.DOTALL)
OTHER_CONSTANT = re.compile(r"\b(k_\w+)\b")
FIELD = re.compile(r"^\s*[\w:<>]+\s+(\w+)\s*=\s*([^;]*);", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
COMMENT = re.compile(r"^(?P<code>(?:[^\"/]|\"(?:\\.|[^\"\\])*\"|/(?!/))*)//(?P<text>.*)$")
ABBREVIATION = re.compile(r"\b(e\.g|i\.e)\.")

OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.LShift: operator.lshift}
KNOWN = {"k_pi": math.pi, "k_degree": math.pi / 180.0}


class Breach(NamedTuple):
    file: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


def without_comments(text: str) -> str:
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def value_of(expression: str, constants: dict[str, float]) -> float | None:
    """The value of a C++ arithmetic expression over known constants; None for anything else."""
    plain = re.sub(r"(?<=[0-9])'(?=[0-9])", "", expression)
    plain = re.sub(r"\b(\d[\w.]*?)(?:[uUlLfF]+)\b", r"\1", plain).strip()

    def walk(node) -> float:
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.Name):
            return constants[node.id]
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -walk(node.operand)
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](walk(node.left), walk(node.right))
        raise ValueError

    try:
        return float(walk(ast.parse(plain, mode="eval").body))
    except (KeyError, ValueError, SyntaxError, ZeroDivisionError, TypeError):
        return None


def si_value(name: str, value: float) -> float:
    for suffix, unit in SUFFIXES.items():
        if name.endswith(suffix):
            return value * UNITS[unit]
    return value


class Header(NamedTuple):
    text: str
    names: set[str]  # constants that it mentions outside of comments
    declared: list[tuple[str, str]]  # name and expression
    includes: list[str]


class Tree:
    """The headers of a repository, and which constants each of them sees."""

    def __init__(self, root: Path):
        self.root = root
        self.headers: dict[str, Header | None] = {}
        self.tuning = self.read_tuning()
        self.declared_anywhere: dict[str, set[float]] = {}  # by name: the values, none if they cannot be computed
        for folder in ("engine", "components", "systems"):
            for file in sorted((root / folder).rglob("*.hpp")):
                for name, expression in self.header(file.relative_to(root).as_posix()).declared:
                    value = value_of(expression, KNOWN)
                    self.declared_anywhere.setdefault(name, set()).update(() if value is None else {si_value(name, value)})

    def header(self, path: str) -> Header | None:
        if path not in self.headers:
            file = self.root / path
            if not file.is_file():
                self.headers[path] = None
                return None
            text = file.read_text(encoding="utf-8")
            code = without_comments(text)
            self.headers[path] = Header(text, set(OTHER_CONSTANT.findall(code)), DECLARATION.findall(code), INCLUDE.findall(text))
        return self.headers[path]

    def reached(self, path: str) -> list[Header]:
        found, queue = {}, [path]
        for name in queue:
            header = self.header(name)
            if header is not None and name not in found:
                found[name] = header
                queue.extend(header.includes)
        return list(found.values())

    def constants(self, path: str) -> tuple[set[str], dict[str, float]]:
        """Names of the constants that a header sees, and the SI values of those that can be computed."""
        headers = self.reached(path)
        names = set(KNOWN).union(*(header.names for header in headers)) if headers else set(KNOWN)
        values = dict(KNOWN)
        declared = [entry for header in headers for entry in header.declared]
        for _ in range(4):  # constants made of others
            for name, expression in declared:
                value = value_of(expression, values)
                if value is not None:
                    values.setdefault(name, value)
        return names, {name: si_value(name, value) for name, value in values.items()}

    def read_tuning(self) -> dict[str, dict[str, float | None]]:
        """Struct or group -> field -> default."""
        found: dict[str, dict[str, float | None]] = {}
        for path in TUNING:
            file = self.root / path
            if not file.is_file():
                continue
            code = without_comments(file.read_text(encoding="utf-8"))
            for struct, body in re.findall(r"struct (\w+Tuning) \{(.*?)\n\};", code, re.DOTALL):
                fields = found.setdefault(struct, {})
                for name, expression in FIELD.findall(body):
                    value = value_of(expression, KNOWN)
                    fields[name] = None if value is None else si_value(name, value)
            for struct, group in re.findall(r"\b(\w+Tuning) (\w+);", code):
                if struct in found:
                    found[group] = found[struct]
        return found


def sentences_of(lines: list[tuple[int, str]]) -> Iterator[tuple[list[tuple[int, int]], str]]:
    """Sentences of a comment, each with the places (offset in the sentence, line) at which its lines begin."""
    places, sentence = [], ""
    for number, text in lines:
        text = ABBREVIATION.sub(lambda m: m[1].replace(".", "_") + "_", text.strip())
        if not text:
            if sentence:
                yield places, sentence
            places, sentence = [], ""
            continue
        for piece in re.split(r"(?<=[.!?])\s+(?=[A-Z`\"(0-9])", text):
            places.append((len(sentence), number))
            sentence += piece + " "
            if re.search(r"[.!?]$", piece):
                yield places, sentence
                places, sentence = [], ""
    if sentence:
        yield places, sentence


def comments_of(text: str) -> Iterator[tuple[list[tuple[int, str]], list[str]]]:
    """Each comment as (line, text), with the constants that the code beside it declares."""
    block: list[tuple[int, str]] = []
    for number, line in enumerate(text.split("\n"), start=1):
        found = COMMENT.match(line)
        if found and not found["code"].strip():
            block.append((number, found["text"]))
            continue
        if block:
            yield block, []
            block = []
        if found:
            yield [(number, found["text"])], [name for name, _ in DECLARATION.findall(found["code"])]
    if block:
        yield block, []


def equals(a: float, b: float) -> bool:
    """True for values that agree in the two or three digits that a comment gives."""
    return math.isclose(a, b, rel_tol=5e-3, abs_tol=1e-15)


def tuning_values(tree: Tree, sentence: str) -> Iterator[tuple[str, bool, float | None]]:
    """Fields of the tuning that a sentence names: the name, whether it exists, its default."""
    for struct, field in TUNING_FIELD.findall(sentence):
        fields = tree.tuning.get(struct, {})
        yield f"{struct}::{field}", field in fields, fields.get(field)
    for group, fields in tree.tuning.items():
        for field in re.findall(rf"(?<![\w.:]){group}\.(\w+)\b(?!\()", sentence) if group[0].islower() else ():
            if field in fields or "_" in field:  # `palm.up` is a member of something else
                yield f"{group}.{field}", field in fields, fields.get(field)


def breaches_of_sentence(tree: Tree, sentence: str, beside: list[str], names: set[str],
                         values: dict[str, float]) -> Iterator[tuple[int, str]]:
    """Offset and text of each breach in a sentence. `names`: constants that its header sees; `values`: those with known values."""
    known = [values[name] for name in beside if name in values]
    for found in CONSTANT_NAME.finditer(sentence):
        if found[0] in values:
            known.append(values[found[0]])
        elif found[0] in tree.declared_anywhere:
            known.extend(tree.declared_anywhere[found[0]])
        elif found[0] not in names:
            yield found.start(), f"{found[0]}: no header has a constant with this name"
    for name, exists, value in tuning_values(tree, sentence):
        if not exists:
            yield sentence.index(name), f"{name}: no such number in the tuning"
        elif value is not None:
            known.append(value)
    if KINDS.search(sentence):
        return
    for found in NUMBER.finditer(NOT_ANGLES.sub(lambda m: " " * len(m[0]), sentence)):
        value = float(found["number"]) * UNITS[found["unit"]]
        if not any(equals(value, other) for other in known):
            yield found.start(), (f"{found['number']} {found['unit']}: no constant or tuning field beside it has this value; name the one"
                                  " that the code uses, or say what kind of number this is (tools/check_contracts.py)")


def breaches_of(tree: Tree, path: str) -> Iterator[Breach]:
    header = tree.header(path)
    if header is None or GENERATED.search(header.text):
        return
    names, values = tree.constants(path)
    for lines, beside in comments_of(header.text):
        for places, sentence in sentences_of(lines):
            for offset, text in breaches_of_sentence(tree, sentence, beside, names, values):
                line = max(number for start, number in places if start <= offset)
                yield Breach(path, line, text)


def check_tree(root: Path) -> list[Breach]:
    tree = Tree(root)
    files = [path.relative_to(root).as_posix() for folder in FOLDERS for path in sorted((root / folder).rglob("*.hpp"))]
    return [breach for file in files for breach in breaches_of(tree, file)]


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    if not (root / "engine").is_dir():
        print(f"check_contracts: {root}: no folder engine/ here", file=sys.stderr)
        return 1
    breaches = check_tree(root)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
