"""Reads the C interface (systems/host/include/handhold/*.h) into a description that generators and handhold.json share.

The headers are a subset of C99: enums, structs, opaque structs, function pointers, functions, numeric constants and comments. Everything else,
and every parameter whose purpose is not clear from its type and the function's comment, is an error: extend this file, or write the header as the
others. The comment says what a type cannot:
    `NAME`: HH_X_COUNT elements     the parameter points to so many
    null                            the function's pointer to a const struct may be null (definitions: by their type)
    `NAME`, not null                it may not

A comment before a declaration documents it; a comment behind a field or an enumerator documents that.
"""
import re
from dataclasses import dataclass, field
from pathlib import Path

HEADERS = ("version.h", "base.h", "convert.h", "world.h", "level.h", "players.h", "your_physics.h")

SCALARS = {"double": 8, "float": 4, "int32_t": 4, "uint32_t": 4, "uint64_t": 8, "uint8_t": 1, "size_t": 0, "char": 1, "void": 0}

# Array fields with more than one element per count: struct.field -> (field with the count, elements per count).
COUNTED_FIELDS = {"hh_mesh_def.positions": ("vertex_count", 3)}

TOKEN = re.compile(r'/\*.*?\*/|"[^"\n]*"|\w+|\.\.\.|[^\s\w]', re.DOTALL)


class HeaderError(Exception):
    """A declaration that the parser does not understand."""


@dataclass
class Token:
    text: str
    file: str
    line: int
    first_of_line: bool
    end_line: int


@dataclass
class Description:
    constants: list = field(default_factory=list)
    enums: list = field(default_factory=list)
    handles: list = field(default_factory=list)
    callbacks: list = field(default_factory=list)
    structs: list = field(default_factory=list)
    functions: list = field(default_factory=list)


def prose(comment: str) -> str:
    lines = [re.sub(r"^\s*\* ?", "", line) for line in comment[2:-2].split("\n")]
    paragraphs = "\n".join(line.strip() for line in lines).strip().split("\n\n")
    return "\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)


def tokens_of(path: Path, constants: list) -> list[Token]:
    """Tokens without preprocessor lines and without what only C++ compiles; numeric macros go to `constants`."""
    text = path.read_text(encoding="utf-8")
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])
    text = re.sub(r"^#ifdef __cplusplus\n.*?^#endif$", blank, text, flags=re.MULTILINE | re.DOTALL)
    for name, value in re.findall(r"^#define ((?:HH|HANDHOLD)_\w+) +(\d+|\"[^\"]*\")$", text, re.MULTILINE):
        constants.append({"name": name, "value": value[1:-1] if value.startswith('"') else int(value)})
    text = re.sub(r"^#.*(?:\\\n.*)*$", lambda found: blank(found).replace(" ", "\x01"), text, flags=re.MULTILINE)
    tokens = []
    previous_line = 0
    for found in TOKEN.finditer(text.replace("\x01", " ")):
        line = text.count("\n", 0, found.start()) + 1
        end_line = line + found[0].count("\n")
        tokens.append(Token(found[0], path.name, line, line != previous_line, end_line))
        previous_line = end_line
    return tokens


class Reader:
    def __init__(self, tokens: list[Token], description: Description):
        self.tokens = tokens
        self.at = 0
        self.out = description
        self.numbers = {one["name"]: one["value"] for one in description.constants}

    def fail(self, what: str):
        token = self.tokens[min(self.at, len(self.tokens) - 1)]
        raise HeaderError(f"{token.file}:{token.line}: {what} (at \"{token.text}\")")

    def peek(self) -> str:
        return self.tokens[self.at].text if self.at < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        text = self.peek()
        if not text or (wanted and text != wanted):
            self.fail(f'expected "{wanted}"' if wanted else "the header ends too early")
        self.at += 1
        return text

    def skip(self, wanted: str) -> bool:
        if self.peek() == wanted:
            self.at += 1
            return True
        return False

    def comments(self, of: dict) -> str:
        """Takes comments: those on the line of the token before belong to `of`, the last one directly above the next token is returned."""
        doc = ""
        while self.peek().startswith("/*"):
            token = self.tokens[self.at]
            text = prose(token.text)
            self.at += 1
            if not token.first_of_line and of is not None:
                of["doc"] = " ".join(filter(None, (of.get("doc", ""), text)))
                continue
            follows = self.tokens[self.at] if self.at < len(self.tokens) else token
            is_heading = text.startswith("----") or follows.line > token.end_line + 1
            doc = "" if is_heading else text
        return doc

    def type(self) -> dict:
        is_const = self.skip("const")
        base = self.take()
        stars = 0
        while self.skip("*"):
            stars += 1
        return {"type": base, "pointer": stars, "const": is_const}

    def parameters(self) -> list:
        self.take("(")
        if self.peek() == "void" and self.tokens[self.at + 1].text == ")":
            self.at += 1
        params = []
        while not self.skip(")"):
            if params:
                self.take(",")
            one = self.type()
            params.append({"name": self.take(), **one})
        return params

    def read(self) -> None:
        last = None
        while self.at < len(self.tokens):
            doc = self.comments(last)
            if self.at >= len(self.tokens):
                break
            if self.skip("typedef"):
                last = self.typedef(doc)
            elif self.skip("HH_API"):
                last = self.function(doc)
            elif self.skip("static"):
                while self.take() != "{":
                    pass
                depth = 1
                while depth > 0:
                    depth += {"{": 1, "}": -1}.get(self.take(), 0)
                last = None
            else:
                self.fail("not a typedef, a function or an inline function")

    def function(self, doc: str) -> dict:
        returns = self.type()
        made = {"name": self.take(), "doc": doc, "returns": returns, "params": self.parameters(), "header": self.tokens[self.at - 1].file}
        self.take(";")
        self.out.functions.append(made)
        return made

    def typedef(self, doc: str) -> dict:
        if self.skip("enum"):
            return self.enum(doc)
        if self.skip("struct"):
            name = self.take()
            if self.skip("{"):
                return self.struct(name, doc)
            self.take(name)
            self.take(";")
            self.out.handles.append({"name": name, "doc": doc})
            return self.out.handles[-1]
        returns = self.type()
        self.take("(")
        self.take("*")
        name = self.take()
        self.take(")")
        made = {"name": name, "doc": doc, "returns": returns, "params": self.parameters()}
        self.take(";")
        self.out.callbacks.append(made)
        return made

    def enum(self, doc: str) -> dict:
        name = self.take()
        self.take("{")
        values = []
        following = 0
        last = None
        before = self.comments(None)
        while not self.skip("}"):
            value = {"name": self.take(), "doc": before}
            if self.skip("="):
                following = int(self.take(), 0)
            value["value"] = following
            self.numbers[value["name"]] = following
            following += 1
            last = value
            if not value["name"].endswith("_32_BITS"):
                values.append(value)
            before = self.comments(last)
            if self.skip(","):
                before = self.comments(last)
        self.take(name)
        self.take(";")
        self.out.enums.append({"name": name, "doc": doc, "values": values})
        return self.out.enums[-1]

    def struct(self, name: str, doc: str) -> dict:
        fields = []
        last = None
        while True:
            before = self.comments(last)
            if self.skip("}"):
                break
            kind = self.type()
            if self.skip("("):
                self.take("*")
                made = {"name": self.take(), "doc": before}
                self.take(")")
                made |= {"type": f"{name}_{made['name']}", "pointer": 0, "const": False}
                self.out.callbacks.append({"name": made["type"], "doc": before, "returns": kind, "params": self.parameters(), "member_of": name})
                fields.append(made)
            else:
                while True:
                    made = {"name": self.take(), "doc": before, **kind}
                    if self.skip("["):
                        length = self.take()
                        made["length"] = int(length) if length.isdigit() else self.numbers[length]
                        self.take("]")
                    fields.append(made)
                    if not self.skip(","):
                        break
            self.take(";")
            last = made
        self.take(name)
        self.take(";")
        self.out.structs.append({"name": name, "doc": doc, "fields": fields})
        return self.out.structs[-1]


# ---- Purposes: what a parameter or a field is for, so that each language can offer lists, texts and return values.


class Purposes:
    """Adds "role" to each parameter of the functions and "counts"/"counted_by" to fields."""

    def __init__(self, out: Description):
        self.out = out
        self.structs = {one["name"]: one for one in out.structs}
        self.handles = {one["name"] for one in out.handles}
        self.values = set(SCALARS) | {one["name"] for one in out.enums} | set(self.structs)
        self.numbers = {one["name"]: one["value"] for one in out.constants}
        for enum in out.enums:
            self.numbers |= {value["name"]: value["value"] for value in enum["values"]}

    def grows(self, name: str) -> bool:
        return name in self.structs and self.structs[name]["fields"][0]["name"] == "struct_size"

    def add(self) -> None:
        for struct in self.out.structs:
            self.fields(struct)
        for function in self.out.functions:
            if re.fullmatch(r"hh_default_\w+_sized", function["name"]):
                function["default_of"] = function["params"][0]["type"]
                continue
            self.parameters(function)
        for callback in self.out.callbacks:
            self.callback(callback)

    def callback(self, callback: dict) -> None:
        """What the host's function gets: "context", "value", "text", "array" with "count", "task" with "task_context", "out"."""
        for one, following in zip(callback["params"], [*callback["params"][1:], {"type": ""}]):
            if "role" in one:
                continue
            if one["type"] == "void":
                one["role"] = "context"
            elif one["type"] == "hh_task":
                one["role"], following["role"] = "task", "task_context"
            elif one["pointer"] == 0:
                one["role"] = "value"
            elif one["type"] == "char":
                one["role"] = "text"
            elif one["const"] and following["type"] == "size_t":
                one["role"], one["count"], following["role"] = "array", following["name"], "count"
            elif not one["const"]:
                one["role"] = "out"
            else:
                raise HeaderError(f"{callback['name']}: {one['name']}: a pointer without a purpose")

    def fields(self, struct: dict) -> None:
        fields = {one["name"]: one for one in struct["fields"]}
        for one in struct["fields"]:
            if one["pointer"] == 0 or one["type"] in ("char", "void"):
                continue
            count, elements = COUNTED_FIELDS.get(f"{struct['name']}.{one['name']}", (None, 1))
            stems = [one["name"], re.sub(r"s$", "", one["name"]), re.sub(r"ices$", "ex", one["name"]), re.sub(r"ies$", "y", one["name"])]
            count = count or next((f"{stem}_count" for stem in stems if f"{stem}_count" in fields), None)
            if count is not None:
                one |= {"counted_by": count, "elements_each": elements}
                fields[count].setdefault("counts", one["name"])

    def parameters(self, function: dict) -> None:
        params = function["params"]
        self.lengths(function)
        at = 0
        while at < len(params):
            at += self.purpose(function, params, at)

    def lengths(self, function: dict) -> None:
        """Sets the "length" of parameters that the comment gives a constant number of elements."""
        params = {one["name"]: one for one in function["params"] if one["pointer"] == 1}
        named = re.findall(r"`(\w+)`: (HH_\w+_COUNT) elements", function["doc"])
        if len(named) != len(re.findall(r"_COUNT elements", function["doc"])):
            raise HeaderError(f"{function['name']}: which parameter has so many elements? Write `NAME`: HH_X_COUNT elements")
        for name, count in named:
            if name not in params or count not in self.numbers:
                raise HeaderError(f"{function['name']}: `{name}`: {count} elements: no such pointer or constant")
            params[name]["length"] = self.numbers[count]

    def purpose(self, function: dict, params: list, at: int) -> int:
        """Sets the role of params[at] and of those that belong to it; returns how many."""
        one = params[at]
        following = params[at + 1:]

        def is_size(index: int, stars: int) -> bool:
            return len(following) > index and following[index]["type"] == "size_t" and following[index]["pointer"] == stars

        if one["type"] == "size_t" and one["pointer"] == 0 and re.fullmatch(r"(\w+_)?size", one["name"]):
            one["role"] = "struct_size"  # of the struct that the function writes or lists
            one["of"] = self.sized_struct(function, one["name"])
            return 1
        if one["pointer"] == 0:
            if one["type"] not in self.values:
                raise HeaderError(f"{function['name']}: unknown type {one['type']}")
            one["role"] = "value"
            return 1
        if one["type"] in self.handles:
            one["role"] = "out_handle" if one["pointer"] == 2 else "self" if at == 0 else "handle"
            return 1
        if one["pointer"] == 2:
            if one["type"] == "char":
                one["role"] = "out_text"
                return 1
            if one["const"] and is_size(0, 1):
                one["role"], following[0]["role"] = "out_view", "count_out"
                return 2
            raise HeaderError(f"{function['name']}: {one['name']}: a pointer to a pointer that is no text, handle or list")
        if one["const"]:
            is_counted = is_size(0, 0) and (one["type"] in ("void", "char") or not following[0]["name"].endswith("_size"))
            if is_counted:
                one["role"], one["count"] = ("bytes" if one["type"] in ("void", "char") else "array"), following[0]["name"]
                following[0]["role"] = "count"
                return 2
            one["role"] = "text" if one["type"] == "char" else "array" if "length" in one else self.struct_given(function, one)
            return 1
        if is_size(0, 0) and following[0]["name"] == "capacity" and is_size(1, 1):
            one["role"] = "out_bytes" if one["type"] == "void" else "out_list"
            following[0]["role"], following[1]["role"] = "capacity", "count_out"
            return 3
        if is_size(0, 0) and following[0]["name"] == "count":
            one["role"], one["count"], following[0]["role"] = "out_array", "count", "count"
            return 2
        if is_size(0, 0) and following[0]["name"].endswith("_count"):
            one["role"], one["count"], following[0]["role"] = "in_place", following[0]["name"], "count"
            return 2
        counted = next((p for p in params[:at] if p.get("role") == "array" and "count" in p), None)
        if counted is not None and one["name"].endswith("s"):
            one["role"], one["count"] = "out_array", counted["count"]
            return 1
        one["role"] = "out_array" if "length" in one else "in_out" if self.grows(one["type"]) else "out"
        return 1

    def struct_given(self, function: dict, one: dict) -> str:
        """What a pointer to one const struct is: "optional" (null has a meaning, or it is a definition, which has defaults) or "required"."""
        if one["type"] not in self.structs:
            raise HeaderError(f"{function['name']}: {one['name']}: a pointer to const {one['type']} without a count")
        if f"`{one['name']}`, not null" in function["doc"]:
            return "required"
        if one["type"].endswith("_def") or re.search(r"\bnull: ", function["doc"], re.IGNORECASE):
            return "optional"
        raise HeaderError(f"{function['name']}: {one['name']}: one struct, or how many? May it be null? The comment has to say it")

    def sized_struct(self, function: dict, name: str) -> str:
        stem = name.removesuffix("size").removesuffix("_")
        pointers = [p["type"] for p in function["params"] if p["pointer"] > 0 and p["type"] in self.structs]
        candidates = [one for one in pointers if one.endswith(stem)] + [one for one in self.structs if one == f"hh_{stem}_state"]
        if len(candidates) == 1 or len(set(pointers)) == 1 and not candidates:
            return (candidates + pointers)[0]
        raise HeaderError(f"{function['name']}: {name}: the size of which struct?")


# ---- Layouts.


def layout(description: Description, pointer: int) -> dict:
    """Size and alignment of each struct, with offsets by field, for pointers and size_t of `pointer` bytes."""
    known = {name: (size or pointer, size or pointer) for name, size in SCALARS.items()}
    known |= {one["name"]: (4, 4) for one in description.enums}
    known |= {one["name"]: (pointer, pointer) for one in description.callbacks}
    layouts = {}
    for struct in description.structs:
        size, align, offsets = 0, 1, {}
        for one in struct["fields"]:
            field_size, field_align = (pointer, pointer) if one["pointer"] else known[one["type"]]
            size = -(-size // field_align) * field_align
            offsets[one["name"]] = size
            size += field_size * one.get("length", 1)
            align = max(align, field_align)
        size = -(-size // align) * align
        known[struct["name"]] = (size, align)
        layouts[struct["name"]] = {"size": size, "align": align, "offsets": offsets}
    return layouts


def read(include: Path) -> Description:
    """The description of the headers below `include`. Throws HeaderError."""
    description = Description()
    missing = {one.name for one in (include / "handhold").glob("*.h")} - set(HEADERS) - {"handhold.h"}
    if missing:
        raise HeaderError(f"headers that read_headers.HEADERS lacks: {', '.join(sorted(missing))}")
    for name in HEADERS:
        tokens = tokens_of(include / "handhold" / name, description.constants)
        Reader(tokens, description).read()
    Purposes(description).add()
    return description
