"""Writes csharp/Handhold.g.cs: enums, structs, delegates, P/Invoke declarations and wrappers of the C interface. C# 7, as Unity and Mono know it."""
from names import camel, enum_prefix, has_callbacks, is_own_count, is_raw_only, method, pascal, self_of

SCALARS = {"double": "double", "float": "float", "int32_t": "int", "uint32_t": "uint", "uint64_t": "ulong", "uint8_t": "byte",
           "size_t": "UIntPtr", "char": "byte", "void": "void"}
KEYWORDS = {"event", "in", "out", "params", "object", "string", "base", "fixed", "lock", "ref", "is", "as", "operator"}


# Names of UnityEngine's and System's types: ours begin with Hh, so that a script can use all three namespaces.
CLASHES = {"Pose", "Mesh", "Space", "Event", "Joint", "Task"}


def type_name(c_name: str) -> str:
    name = pascal(c_name)
    return "Hh" + name if name in CLASHES else name


def safe(name: str) -> str:
    return "@" + name if name in KEYWORDS else name


def summary(text: str, indent: str) -> list[str]:
    if not text:
        return []
    shown = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").split("\n")
    if len(shown) == 1:
        return [f"{indent}/// <summary>{shown[0]}</summary>"]
    return [f"{indent}/// <summary>", *[f"{indent}/// {line}" for line in shown], f"{indent}/// </summary>"]


class CSharp:
    def __init__(self, description):
        self.description = description
        self.structs = {one["name"]: one for one in description.structs}
        self.enums = {one["name"] for one in description.enums}
        self.handles = {one["name"] for one in description.handles}
        self.callbacks = {one["name"] for one in description.callbacks}
        self.inline_arrays = set()
        self.lines = []

    def scalar(self, name: str) -> str:
        return SCALARS.get(name) or type_name(name)

    def c_type(self, one: dict) -> str:
        base, stars = one["type"], one["pointer"]
        if base in self.callbacks:
            return "IntPtr"
        if base in self.handles:
            return "IntPtr" + "*" * (stars - 1)
        if base == "void" and stars == 1 and one.get("name", "").endswith("context"):
            return "IntPtr"
        return self.scalar(base) + "*" * stars

    def shown_type(self, one: dict) -> str:
        """The type in wrappers."""
        base = one["type"]
        return {"uint8_t": "bool", "size_t": "long"}.get(base) or self.scalar(base)

    def field_type(self, part: dict) -> str:
        kind = "Flag" if part["type"] == "uint8_t" and part["pointer"] == 0 else self.c_type(part)
        if "length" not in part:
            return kind
        self.inline_arrays.add((kind, part["length"]))
        return f"{kind[:1].upper()}{kind[1:]}Array{part['length']}"

    def parameters(self, params: list) -> str:
        return ", ".join(f"{self.c_type(one)} {safe(one['name'])}" for one in params)

    def enum(self, one: dict) -> None:
        prefix = enum_prefix(one)
        self.lines += ["", *summary(one["doc"], "    "), f"    public enum {type_name(one['name'])} {{"]
        for value in one["values"]:
            name = "".join(word.capitalize() for word in value["name"].removeprefix(prefix).split("_"))
            self.lines += [*summary(value["doc"], "        "), f"        {name} = {value['value']},"]
        self.lines.append("    }")

    def callback(self, one: dict) -> None:
        self.lines += ["", *summary(one["doc"], "    "), "    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]",
                       f"    public unsafe delegate {self.c_type(one['returns'])} {type_name(one['name'])}({self.parameters(one['params'])});"]

    def struct(self, one: dict) -> None:
        name = type_name(one["name"])
        self.lines += ["", *summary(one["doc"], "    "), "    [StructLayout(LayoutKind.Sequential)]", f"    public unsafe partial struct {name} {{"]
        if has_callbacks(one, self.callbacks):
            self.lines[-2:-2] = ["    /// <remarks>For Native: keep the delegates of all functions alive while the library may call them, and make them static methods with",
                                 "    /// MonoPInvokeCallback for IL2CPP. World.SetSurfaces, Match and Library.SetLog do both.</remarks>"]
        for part in one["fields"]:
            self.lines += [*summary(part.get("doc", ""), "        "), f"        public {self.field_type(part)} {safe(part['name'])};"]
        default = next((f["name"] for f in self.description.functions if f.get("default_of") == one["name"]), "")
        if default:
            self.lines += ["", "        /// <summary>The library's defaults.</summary>", f"        public static {name} Default() {{",
                           f"            {name} filled;", f"            Library.Check(Native.{default}(&filled, (UIntPtr)sizeof({name})));",
                           "            return filled;", "        }"]
        if [part["type"] for part in one["fields"]] in (["double"] * 3, ["double"] * 4, ["uint32_t"] * 2):
            parts = [(self.scalar(part["type"]), part["name"]) for part in one["fields"]]
            self.lines += ["", f"        public {name}({', '.join(f'{kind} {field}' for kind, field in parts)}) {{"]
            self.lines += [f"            this.{field} = {field};" for _, field in parts] + ["        }"]
            if parts[0][0] == "uint":
                self.lines += ["        /// <summary>True for the null id.</summary>",
                               "        public bool IsNull => index == 0 && generation == 0;",
                               f"        public static bool operator ==({name} a, {name} b) => a.index == b.index && a.generation == b.generation;",
                               f"        public static bool operator !=({name} a, {name} b) => !(a == b);",
                               f"        public override bool Equals(object other) => other is {name} && this == ({name})other;",
                               "        public override int GetHashCode() => (int)(index * 2654435761u ^ generation);"]
        self.lines.append("    }")

    def inline_array(self, kind: str, length: int) -> None:
        name = f"{kind[:1].upper()}{kind[1:]}Array{length}"
        cases = range(length)
        self.lines += ["", f"    /// <summary>{length} elements inside of a struct. Write an element by its index; to change a part of it, read, change, write."
                       "</summary>", "    [StructLayout(LayoutKind.Sequential)]", f"    public struct {name} {{",
                       f"        private {kind} {', '.join(f'e{i}' for i in cases)};", f"        public const int Length = {length};",
                       f"        public {kind} this[int index] {{", "            get {", "                switch (index) {"]
        self.lines += [f"                    case {i}: return e{i};" for i in cases]
        self.lines += ["                    default: throw new IndexOutOfRangeException();", "                }", "            }", "            set {",
                       "                switch (index) {"]
        self.lines += [f"                    case {i}: e{i} = value; break;" for i in cases]
        self.lines += ["                    default: throw new IndexOutOfRangeException();", "                }", "            }", "        }", "    }"]

    def texts_of(self, one: dict) -> list:
        return [part["name"] for part in self.structs.get(one["type"], {"fields": []})["fields"] if part["type"] == "char"]

    def wrapper(self, function: dict) -> None:
        params, before, fixes, call, results, after = [], [], [], [], [], []
        lists, last = [], []
        for one in function["params"]:
            name, role, kind = safe(one["name"]), one.get("role"), self.scalar(one["type"])
            at = one["name"] + "_at"
            if role == "self":
                call.append("Handle")
            elif role == "value":
                params.append(f"{self.shown_type(one)} {name}")
                call.append({"uint8_t": f"(byte)({name} ? 1 : 0)", "size_t": f"(UIntPtr)(ulong){name}"}.get(one["type"], name))
            elif role == "handle":
                params.append(f"{type_name(one['type'])} {name}")
                call.append(f"{name} == null ? IntPtr.Zero : {name}.Handle")
            elif role == "text":
                params.append(f"string {name}")
                fixes.append(f"byte* {at} = Library.Text({name})")
                call.append(at)
            elif role == "required":
                params.append(f"{kind} {name}")
                call.append(f"&{name}")
            elif role == "optional":
                texts = self.texts_of(one)
                params.append(f"{kind}? {name}" + "".join(f", string {text} = null" for text in texts))
                before.append(f"{kind} {at} = {name}.GetValueOrDefault();")
                for text in texts:
                    fixes.append(f"byte* {text}_at = Library.Text({text})")
                    after.append(f"if ({text} != null) {at}.{text} = {text}_at;")
                call.append(f"{name}.HasValue ? &{at} : null")
            elif role in ("array", "bytes", "in_place"):
                if "length" in one:
                    before.append(f'Library.RequireLength({name}, {one["length"]}, "{one["name"]}");')
                params.append(f"{'byte' if role == 'bytes' else kind}[] {name}")
                texts = self.texts_of(one) if role == "array" else []
                given = f"{one['name']}_given" if texts else name
                if texts:
                    before.append(f"{kind}[] {given} = Library.Copy({name});")
                fixes.append(f"{'byte' if role == 'bytes' else kind}* {at} = {given}")
                for text in texts:  # parallel to the elements
                    last.append(f"string[] {text}s = null")
                    before.append(f'byte[] {text}s_bytes = Library.Texts({text}s, {name}, "{text}s");')
                    fixes.append(f"byte* {text}s_at = {text}s_bytes")
                    after.append(f"for (int at = 0, i = 0; {text}s != null && i < {text}s.Length; at += Library.Size({text}s[i]), ++i) "
                                 f"{at}[i].{text} = {text}s[i] == null ? null : {text}s_at + at;")
                call.append(at)
            elif role == "count":
                owner = next(p for p in function["params"] if p.get("count") == one["name"])
                if owner["role"] == "out_array" and is_own_count(function, owner):
                    params.append(f"int {name}")
                    call.append(f"(UIntPtr)(uint){name}")
                else:
                    call.append(f"Library.Count({safe(owner['name'])})")
            elif role in ("out", "in_out"):
                results.append((self.shown_type(one), name))
                before.append(f"{kind} {at}{f' = {kind}.Default()' if role == 'in_out' else ''};")
                call.append(f"&{at}")
                value = {"uint8_t": f"{at} != 0", "size_t": f"(long){at}"}.get(one["type"], at)
                lists.append(f"{name} = {value};")
            elif role == "out_text":
                results.append(("string", name))
                before.append(f"byte* {at};")
                call.append(f"&{at}")
                lists.append(f"{name} = Library.Text({at});")
            elif role == "out_array":
                length = one.get("length") or (safe(one["count"]) if is_own_count(function, one) else
                                               next(f"(int)Library.Count({safe(p['name'])})" for p in function["params"] if p.get("role") == "array"))
                results.append((f"{kind}[]", name))
                before.append(f"{kind}[] {one['name']}_made = new {kind}[{length}];")
                fixes.append(f"{kind}* {at} = {one['name']}_made")
                call.append(at)
                lists.append(f"{name} = {one['name']}_made;")
            elif role in ("out_list", "out_bytes"):
                kind = "byte" if role == "out_bytes" else kind
                results.append((f"{kind}[]", name))
                call += ["LIST", "CAPACITY"]
                lists.append(f"LIST {kind} {name}")
            elif role == "capacity":
                pass
            elif role == "count_out":
                before.append(f"UIntPtr {at};")
                call.append(f"&{at}")
                lists.append(f"COUNT {at}")
            elif role == "out_view":
                results.append((f"{kind}[]", name))
                before.append(f"{kind}* {at};")
                call.append(f"&{at}")
                lists.append(f"VIEW {kind} {name} {at}")
            elif role == "struct_size":
                call.append(f"(UIntPtr)sizeof({type_name(one['of'])})")
            else:
                raise ValueError(f"{function['name']}: {name} has no role")
        self.emit(function, params + last, before, fixes, call, results, after, lists)

    def emit(self, function, params, before, fixes, call, results, after, lists) -> None:
        returns = function["returns"]
        is_checked = returns["type"] == "hh_result" and returns["pointer"] == 0
        single = len(results) == 1 and (is_checked or returns["type"] == "void")
        kind = results[0][0] if single else {"char": "string", "uint8_t": "bool", "hh_result": "void"}.get(returns["type"], self.scalar(returns["type"]))
        if not single:
            params = params + [f"out {one} {name}" for one, name in results]
        name = camel(method(function))
        name = name[:1].upper() + name[1:]
        is_static = not self_of(function)
        self.lines += ["", *summary(function["doc"], "        "),
                       f"        public {'static ' if is_static else ''}unsafe {kind} {name}({', '.join(params)}) {{"]
        indent = " " * 12
        body = []
        if single:
            body.append(f"{results[0][0]} {results[0][1]};")
        body += before
        for fix in fixes:
            body.append(f"fixed ({fix}) {{")
        body += after

        def invoke(*replaced) -> str:
            words = list(call)
            if replaced:
                words[words.index("LIST"):words.index("LIST") + 2] = replaced
            text = f"Native.{function['name']}({', '.join(words)})"
            return f"Library.Check({text});" if is_checked else f"{text};"

        # The collector may finalize an object during the last call that uses its handle.
        used = [safe(p["name"]) for p in function["params"] if p["role"] == "handle"] + ([] if is_static else ["this"])
        alive = [f"GC.KeepAlive({one});" for one in used]
        is_list = "LIST" in call
        if is_list:
            element, out = next(one.split()[1:] for one in lists if one.startswith("LIST"))
            counter = next(one.split()[1] for one in lists if one.startswith("COUNT"))
            body += [invoke("null", "UIntPtr.Zero"), f"{element}[] made = new {element}[(long){counter}];",
                     f"fixed ({element}* made_at = made) {{ {invoke('made_at', counter)} }}"]
            if element == "byte":  # a packet may be shorter than the most that the first call said
                body.append(f"Array.Resize(ref made, (int){counter});")
            body.append(f"{out} = made;")
        elif is_checked or returns["type"] == "void":
            body.append(invoke())
        else:
            value = invoke()[:-1]
            body.append({"char": f"{kind} answer = Library.Text({value});", "uint8_t": f"{kind} answer = {value} != 0;"}.get(returns["type"], f"{kind} answer = {value};"))
            body += [*alive, "return answer;"]
            alive = []
        for one in lists:
            words = one.split()
            if words[0] == "VIEW":
                counter = next(other.split()[1] for other in lists if other.startswith("COUNT"))
                body += [f"{words[1]}[] made = new {words[1]}[(long){counter}];", f"for (long i = 0; i < made.LongLength; ++i) made[i] = {words[3]}[i];",
                         f"{words[2]} = made;"]
            elif words[0] not in ("LIST", "COUNT"):
                body.append(one)
        body += alive + ["}"] * len(fixes)
        if single:
            body.append(f"return {results[0][1]};")
        depth = 0
        for line in body:
            depth -= line == "}"
            self.lines.append(indent + "    " * depth + line)
            depth += line.endswith("{")
        self.lines.append("        }")

    def is_by_hand(self, function: dict) -> bool:
        """Functions that Handhold.cs offers, or what stands for them."""
        return is_raw_only(function) or any(
            p["type"] in self.structs and has_callbacks(self.structs[p["type"]], self.callbacks) for p in function["params"])

    def write(self) -> str:
        d = self.description
        self.lines = ["// The C interface's enums, structs and functions. Made by systems/host/bindings/generate.py; do not edit.", "using System;",
                      "using System.Runtime.InteropServices;", "", "#pragma warning disable 660, 661, 1591", "", "namespace Handhold {"]
        self.lines += ["    /// <summary>Numbers of the C headers.</summary>", "    public static class Constants {"]
        for one in d.constants:
            kind, value = ("string", f'"{one["value"]}"') if isinstance(one["value"], str) else ("int" if one["value"] < 2**31 else "uint", one["value"])
            name = "".join(word.capitalize() for word in one["name"].removeprefix("HH_").split("_"))
            self.lines.append(f"        public const {kind} {name} = {value};")
        self.lines.append("    }")
        for one in d.enums:
            self.enum(one)
        for one in d.callbacks:
            self.callback(one)
        for one in d.structs:
            self.struct(one)
        for kind, length in sorted(self.inline_arrays):
            self.inline_array(kind, length)
        self.lines += ["", "    /// <summary>The functions as they are: nothing is checked, and nothing is allocated.</summary>",
                       "    public static unsafe class Native {",
                       "#if (UNITY_IOS || UNITY_TVOS || UNITY_VISIONOS || UNITY_WEBGL) && !UNITY_EDITOR", '        public const string LibraryName = "__Internal";', "#else",
                       '        public const string LibraryName = "handhold";', "#endif"]
        for one in d.functions:
            returns = "byte*" if one["returns"]["type"] == "char" else self.c_type(one["returns"])
            self.lines += ["        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]",
                           f"        public static extern {returns} {one['name']}({self.parameters(one['params'])});"]
        self.lines += ["    }", "", "    public static partial class Library {"]
        for one in (f for f in d.functions if not self_of(f) and not self.is_by_hand(f)):
            self.wrapper(one)
        for owner in ("hh_world", "hh_match"):
            self.lines += ["    }", "", f"    public partial class {type_name(owner)} {{"]
            for one in (f for f in d.functions if self_of(f) == owner and not self.is_by_hand(f)):
                self.wrapper(one)
        self.lines += ["    }", "}"]
        return "\n".join(self.lines) + "\n"


def write(description) -> dict[str, str]:
    return {"csharp/Handhold.g.cs": CSharp(description).write()}
