"""Writes python/handhold/_generated.py: ctypes structs, function types and wrappers of the C interface."""
import keyword
import textwrap

from names import given, has_callbacks, is_own_count, is_raw_only, method, outputs, pascal, self_of, words

SCALARS = {"double": "c_double", "float": "c_float", "int32_t": "c_int32", "uint32_t": "c_uint32", "uint64_t": "c_uint64", "uint8_t": "c_uint8",
           "size_t": "c_size_t", "char": "c_char_p", "void": "c_void_p"}


def safe(name: str) -> str:
    return {"def": "definition", "from": "start", "to": "end"}.get(name, name + "_" if keyword.iskeyword(name) else name)


def docstring(text: str, indent: str) -> list[str]:
    if not text:
        return []
    lines = [line for paragraph in text.replace("\\", "\\\\").split("\n")
             for line in textwrap.wrap(paragraph, 110 - len(indent)) or [""]]
    lines = [f'{indent}"""{lines[0]}'] + [f"{indent}{line}".rstrip() for line in lines[1:]]
    return lines[:-1] + [lines[-1] + '"""']


class Python:
    def __init__(self, description):
        self.description = description
        self.structs = {one["name"]: one for one in description.structs}
        self.enums = {one["name"] for one in description.enums}
        self.callbacks = {one["name"] for one in description.callbacks}
        self.lines = []

    def scalar(self, name: str) -> str:
        return "c_int32" if name in self.enums else SCALARS.get(name) or pascal(name)

    def c_type(self, one: dict) -> str:
        base, stars = one["type"], one["pointer"]
        if stars == 0:
            return {"void": "None"}.get(base) or (pascal(base) if base in self.callbacks else self.scalar(base))
        if base == "char":
            return "c_char_p" if stars == 1 else "POINTER(c_char_p)"
        if base == "void" or base in {handle["name"] for handle in self.description.handles}:
            return "c_void_p" if stars == 1 else "POINTER(c_void_p)"
        made = f"POINTER({self.scalar(base)})"
        return made if stars == 1 else f"POINTER({made})"

    def callback(self, one: dict) -> None:
        types = ", ".join(self.c_type(part) for part in [one["returns"], *one["params"]])
        self.lines += [f"{pascal(one['name'])} = CFUNCTYPE({types})"]

    def struct(self, one: dict) -> None:
        for callback in self.description.callbacks:
            if callback.get("member_of") == one["name"]:
                self.callback(callback)
        fields = "\n".join(f"{part['name']}: {part['doc']}" for part in one["fields"] if part.get("doc"))
        text = "\n".join(filter(None, (one["doc"] or one["name"], fields)))
        self.lines += ["", "", f"class {pascal(one['name'])}(Struct):", *docstring(text, "    "), "    _fields_ = ["]
        for part in one["fields"]:
            length = f" * {part['length']}" if "length" in part else ""
            self.lines.append(f"        (\"{part['name']}\", {self.c_type(part)}{length}),")
        self.lines.append("    ]")
        default = next((f["name"] for f in self.description.functions if f.get("default_of") == one["name"]), "")
        if default:
            self.lines.append(f"    _default_ = \"{default}\"")
        arrays = {part["name"]: (part["counted_by"], part["elements_each"]) for part in one["fields"] if "counted_by" in part}
        if arrays:
            self.lines.append(f"    _arrays_ = {arrays!r}")

    def wrapper(self, function: dict) -> None:
        handle = self_of(function)
        indent = "    " if handle else ""
        params, fields = (["self"] if handle else []), ""
        for one in given(function):
            is_definition = one["role"] == "optional" and words(one["type"])[-1] == "def"
            params.append(safe(one["name"]) + ("=None" if one["role"] == "optional" else ""))
            fields = ", **fields" if is_definition else fields
        self.lines += ["", *([""] if not handle else []), f"{indent}def {method(function)}({', '.join(params)}{fields}):".replace("(, ", "("),
                       *docstring(function["doc"], indent + "    ")]
        self.lines += [f"{indent}    {line}" for line in self.body(function, bool(fields))]

    def body(self, function: dict, has_fields: bool) -> list[str]:
        lines, words_of_call, results, kept = [], [], [], []
        is_list = False
        for one in function["params"]:
            name, role, kind = safe(one["name"]), one.get("role"), self.scalar(one["type"])
            if role == "self":
                words_of_call.append("self._handle")
            elif role == "value":
                words_of_call.append(f"value({kind}, {name})" if one["type"] in self.structs else name)
            elif role == "handle":
                words_of_call.append(f"handle({name})")
            elif role == "text":
                words_of_call.append(f"text({name})")
            elif role == "optional" and has_callbacks(self.structs[one["type"]], self.callbacks):
                lines.append(f"{name} = held({kind}, {name})")
                words_of_call.append(f"optional({kind}, {name})")
                kept.append(f"{'self.' if self_of(function) else ''}_kept[\"{one['type']}\"] = {name}")
            elif role == "optional":
                words_of_call.append(f"optional({kind}, {name}{', fields' if has_fields else ''})")
            elif role == "required":
                words_of_call.append(f"byref(value({kind}, {name}))")
            elif role == "array" and "length" in one:
                lines.append(f"{name} = fixed({kind}, {name}, {one['length']}, \"{name}\")")
                words_of_call.append(name)
            elif role in ("array", "bytes"):
                count = safe(one["count"])
                make = "raw(" if role == "bytes" else f"array({kind}, "
                lines.append(f"{name}, {count}_ = {make}{name})")
                words_of_call.append(name)
            elif role == "in_place":
                lines.append(f"{name}, {name}_at = changed({kind}, {name})")
                words_of_call.append(f"{name}_at")
                results.append(name)
            elif role == "count":
                owner = next(p for p in function["params"] if p.get("count") == one["name"])
                words_of_call.append(name if owner["role"] == "out_array" and is_own_count(function, owner) else
                                     f"{safe(owner['name'])}.size" if owner["role"] == "in_place" else f"{name}_")
            elif role in ("out", "in_out"):
                lines.append(f"{name} = {kind}()")
                words_of_call.append(f"byref({name})")
                results.append(name if one["type"] in self.structs else f"bool({name}.value)" if one["type"] == "uint8_t" else f"{name}.value")
            elif role == "out_text":
                lines.append(f"{name} = c_char_p()")
                words_of_call.append(f"byref({name})")
                results.append(f"shown({name}.value)")
            elif role == "out_array":
                length = one.get("length") or (safe(one["count"]) if is_own_count(function, one) else safe(one["count"]) + "_")
                lines.append(f"{name}, {name}_at = empty({kind}, {length})")
                words_of_call.append(f"{name}_at")
                results.append(name)
            elif role in ("out_list", "out_bytes"):
                is_list = True
                words_of_call.append("buffer")
                kind = "c_uint8" if role == "out_bytes" else kind
                results.append(f"kind={kind}")
            elif role == "capacity":
                words_of_call.append("capacity")
            elif role == "count_out":
                words_of_call.append("count" if is_list else f"byref({name})")
            elif role == "out_view":
                lines += [f"{name} = POINTER({kind})()", f"{safe(function['params'][function['params'].index(one) + 1]['name'])} = c_size_t()"]
                words_of_call.append(f"byref({name})")
                results.append(f"copied({kind}, {name}, count)")
            elif role == "struct_size":
                words_of_call.append(f"sizeof({pascal(one['of'])})")
            else:
                raise ValueError(f"{function['name']}: {name} has no role")
        call = f"lib().{function['name']}({', '.join(words_of_call)})"
        if is_list:
            kind = next(one for one in results if one.startswith("kind=")).removeprefix("kind=")
            found = [f"listed({kind}, lambda buffer, capacity, count: {call})" if one.startswith("kind=") else one for one in results]
            return lines + [f"return {', '.join(found)}"]
        returns = function["returns"]
        if returns["type"] == "hh_result" and returns["pointer"] == 0:
            return lines + [f"check({call})"] + kept + ([f"return {', '.join(results)}"] if results else [])
        if results:
            return lines + [call, f"return {', '.join(results)}"]
        shown = {"char": f"shown({call})", "uint8_t": f"bool({call})"}.get(returns["type"], call)
        return lines + [f"return {shown}"]

    def write(self) -> str:
        d = self.description
        self.lines = ['"""The C interface\'s structs, enums and functions. Made by systems/host/bindings/generate.py; do not edit."""',
                      "import enum",
                      "from ctypes import (CFUNCTYPE, POINTER, byref, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p,",
                      "                    sizeof)", "",
                      "from ._library import Struct, array, changed, check, copied, empty, fixed, handle, held, lib, listed, optional, raw, shown, text, value", "",
                      "# Structs whose functions the library may call.", "_kept = {}", ""]
        self.lines += [f"{one['name']} = {one['value']!r}" for one in d.constants]
        for one in d.enums:
            self.lines += ["", "", f"class {pascal(one['name'])}(enum.IntEnum):", *docstring(one["doc"] or one["name"], "    ")]
            for v in one["values"]:
                self.lines.append(f"    {v['name']} = {v['value']}" + (f"  # {' '.join(v['doc'].split())}" if v["doc"] else ""))
        self.lines += ["", ""]
        for one in d.enums:
            self.lines += [f"{v['name']} = {pascal(one['name'])}.{v['name']}" for v in one["values"]]
        self.lines += [""]
        for callback in d.callbacks:
            if "member_of" not in callback:
                self.callback(callback)
        for one in d.structs:
            self.struct(one)
        self.lines += ["", "", "# Result and parameters of each function.", "FUNCTIONS = {"]
        for one in d.functions:
            params = ", ".join(self.c_type(part) for part in one["params"])
            returns = "c_char_p" if one["returns"]["type"] == "char" else self.c_type(one["returns"])
            self.lines.append(f"    \"{one['name']}\": ({returns}, [{params}]),")
        self.lines += ["}"]
        for one in (f for f in d.functions if not self_of(f) and not is_raw_only(f)):
            self.wrapper(one)
        of_match = " What a game's function raises is raised\n    when the call has ended, which still takes effect."
        for owner in ("world", "match"):
            also = of_match if owner == "match" else ""
            self.lines += ["", "", f"class {pascal(owner)}Calls:",
                           f'    """Every function of a {owner}, as a method. Calls that the library refuses raise HandholdError and change nothing.{also}"""',
                           "", "    _handle = None"]
            for one in (f for f in d.functions if self_of(f) == f"hh_{owner}" and not is_raw_only(f)):
                self.wrapper(one)
        return "\n".join(self.lines) + "\n"


def write(description) -> dict[str, str]:
    return {"python/handhold/_generated.py": Python(description).write()}
