"""Parses the C interface's headers: tokens and declarations, without their meaning. read_headers.py says what the headers may contain."""
import re
from dataclasses import dataclass, field
from pathlib import Path

TOKEN = re.compile(r'/\*.*?\*/|"[^"\n]*"|\w+|\.\.\.|[^\s\w]', re.DOTALL)


class HeaderError(Exception):
    """A declaration that the parser, or the search for purposes, does not understand."""


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
    for name, value in re.findall(r"^#define ((?:HH|HANDHOLD)_\w+) +(\w+|\"[^\"]*\")(?: */\*.*\*/)?$", text, re.MULTILINE):
        constants.append({"name": name, "value": value[1:-1] if value.startswith('"') else int(value.removesuffix("u"), 0)})
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
