"""Writes javascript/: structs and functions of the C interface as tables for the npm package (game/web/package/src), and their types."""
import json

from names import camel, given, is_own_count, is_raw_only, method, outputs, self_of

KINDS = {"double": "f64", "float": "f32", "int32_t": "i32", "uint32_t": "u32", "uint64_t": "u64", "size_t": "u32", "uint8_t": "bool"}
TYPES = {"f64": "number", "f32": "number", "i32": "number", "u32": "number", "u64": "bigint", "bool": "boolean", "text": "string | null",
         "pointer": "number"}
NOTICE = "// Made from the C headers by systems/host/bindings/generate.py; do not edit.\n"


def doc(text: str, indent: str) -> list[str]:
    if not text:
        return []
    lines = text.replace("*/", "* /").split("\n")
    return [f"{indent}/** {lines[0]}" + (" */" if len(lines) == 1 else ""), *[f"{indent} * {line}" for line in lines[1:]],
            *([f"{indent} */"] if len(lines) > 1 else [])]


class JavaScript:
    def __init__(self, description):
        self.description = description
        self.enums = {one["name"] for one in description.enums}
        self.structs = {one["name"] for one in description.structs}
        self.handles = {one["name"] for one in description.handles}
        self.callbacks = {one["name"]: one for one in description.callbacks}

    def kind(self, one: dict) -> str:
        base = one["type"]
        if one["pointer"] > 0:
            return "text" if base == "char" else "pointer"
        return "i32" if base in self.enums else "callback" if base in self.callbacks else KINDS.get(base, base)

    def element(self, name: str) -> str:
        return self.kind({"type": name, "pointer": 0})

    def field(self, part: dict) -> list:
        if "counted_by" in part:
            return [part["name"], "list", 0, {"of": self.element(part["type"]), "count": part["counted_by"], "each": part["elements_each"]}]
        kind = self.kind(part)
        if kind == "callback":
            one = self.callbacks[part["type"]]
            return [part["name"], kind, 0, {"returns": "void" if one["returns"]["type"] == "void" else self.kind(one["returns"]),
                                            "params": [self.callback_param(p) for p in one["params"]]}]
        return [part["name"], kind] + ([part["length"]] if "length" in part else [])

    def callback_param(self, one: dict) -> list:
        kind = "text" if one["role"] == "text" else "pointer" if one["role"] in ("context", "task", "task_context") else self.element(one["type"])
        return [one["role"], kind]

    def structs_js(self) -> str:
        lines = [NOTICE[:-1]]
        for one in self.description.constants:
            lines.append(f"export const {one['name']} = {json.dumps(one['value'])};")
        for enum in self.description.enums:
            lines += [f"export const {value['name']} = {value['value']};" for value in enum["values"]]
        lines += ["// By struct: [field, kind, length of an array inside, more about lists and callbacks].", "export const structs = {"]
        for struct in self.description.structs:
            lines.append(f"    {struct['name']}: {json.dumps([self.field(part) for part in struct['fields']])},")
        return "\n".join([*lines, "};"]) + "\n"

    def call(self, function: dict) -> dict:
        params = []
        for one in function["params"]:
            role = one["role"]
            if role == "struct_size":
                params.append([role, one["of"]])
            elif role == "count":
                owner = next(p for p in function["params"] if p.get("count") == one["name"])
                own = owner["role"] == "out_array" and is_own_count(function, owner)
                params.append(["own_count" if own else role, owner["name"]])
            elif role == "out_array":
                length = one.get("length", one.get("count"))
                source = next((p["name"] for p in function["params"] if p.get("role") == "array" and p.get("count") == length), length)
                params.append([role, self.element(one["type"]), one["name"], source])
            elif role == "array" and "length" in one:
                params.append([role, self.element(one["type"]), one["name"], one["length"]])
            elif role in ("array", "in_place", "out_list", "out_view", "out", "in_out", "optional", "required"):
                params.append([role, self.element(one["type"]), one["name"]])
            elif role == "value":
                params.append([role, self.kind(one), one["name"]])
            else:
                params.append([role, "", one["name"]])
        returns = function["returns"]
        kind = "result" if returns["type"] == "hh_result" else "void" if returns["type"] == "void" else self.kind(returns)
        return {"method": self.method(function), "of": self_of(function), "returns": kind, "params": params}

    @staticmethod
    def method(function: dict) -> str:
        """hh_match_packet_to -> packetTo."""
        return camel(method(function))

    def wrapped(self) -> list:
        return [one for one in self.description.functions if not is_raw_only(one) and self_of(one) in ("", "hh_world", "hh_match")]

    def calls_js(self) -> str:
        lines = [NOTICE + "// By function: the method, what it belongs to, its result, and for each parameter its purpose, kind and name.",
                 "export const calls = {"]
        lines += [f"    {one['name']}: {json.dumps(self.call(one))}," for one in self.wrapped()]
        return "\n".join([*lines, "};"]) + "\n"

    def plain(self, kind: str) -> str:
        return TYPES.get(kind, kind)

    def field_type(self, part: dict) -> str:
        _, kind, *more = self.field(part)
        if kind == "list":
            return f"{self.plain(more[1]['of'])}[]" if more[1]["of"] in self.structs else "ArrayLike<number>"
        if kind == "callback":
            return self.callback_type(self.callbacks[part["type"]])
        return self.plain(kind) + ("[]" if more else "")

    def callback_type(self, one: dict) -> str:
        words = []
        result = "void" if one["returns"]["type"] == "void" else self.plain(self.kind(one["returns"]))
        result = "bigint | number" if result == "bigint" else result
        for param in one["params"]:
            kind = self.plain(self.element(param["type"])) if param["role"] in ("value", "array", "out") else "string"
            if param["role"] == "out":
                result = f"Given<{kind}> | null"
            elif param["role"] == "task":
                words.append(f"{param['name']}: (index: number) => void")
            elif param["role"] in ("value", "array", "text"):
                words.append(f"{param['name']}: {kind}{'[]' if param['role'] == 'array' else ''}")
        return f"(({', '.join(words)}) => {result}) | null"

    def types(self) -> str:
        lines = [NOTICE[:-1], "", "/** Fields that are left out keep the library's defaults, also inside of structs. Vectors and rotations are given whole. null is no id. */",
                 "export type Given<T> = T extends (...words: never[]) => unknown ? T : T extends (infer One)[] ? Given<One>[]",
                 "    : T extends hh_vec3 | hh_quat ? T : T extends { index: number; generation: number } ? T | null",
                 "    : T extends object ? { [Field in keyof T]?: Given<T[Field]> } : T;", "",
                 "/** A mesh made by Handhold.createMesh. */", "export type Mesh = number & { readonly mesh: unique symbol };", ""]
        for one in self.description.constants:
            lines.append(f"export declare const {one['name']}: {json.dumps(one['value'])};")
        for enum in self.description.enums:
            for value in enum["values"]:
                lines += [*doc(value["doc"], ""), f"export declare const {value['name']}: {value['value']};"]
        for struct in self.description.structs:
            lines += ["", *doc(struct["doc"], ""), f"export interface {struct['name']} {{"]
            for part in struct["fields"]:
                if part["name"] != "struct_size" and "counts" not in part and part["name"] != "context":
                    lines += [*doc(part.get("doc", ""), "    "), f"    {part['name']}: {self.field_type(part)};"]
            lines.append("}")
        for name, handle, what in (("LibraryCalls", "", "the library"), ("WorldCalls", "hh_world", "a world"), ("MatchCalls", "hh_match", "a match")):
            lines += ["", f"/** Every function of {what}, as a method. They throw a HandholdError if the library refuses the call. */",
                      f"export declare class {name} {{"]
            for function in (one for one in self.wrapped() if self_of(one) == handle):
                lines += [*doc(function["doc"], "    "), f"    {self.signature(function)}"]
            lines.append("}")
        return "\n".join(lines) + "\n"

    def signature(self, function: dict) -> str:
        words = []
        for one in given(function):
            kind = self.plain(self.element(one["type"])) if one["role"] in ("value", "array", "in_place", "optional", "required") else ""
            is_struct = one["type"] in self.structs
            shown = f"Given<{kind}>" if is_struct else kind
            words.append(f"{one['name']}: " + {
                "value": shown, "handle": "Mesh | null", "text": "string | null", "bytes": "Uint8Array | string | null", "own_count": "number",
                "array": f"{shown}[]" if is_struct else "ArrayLike<number>", "in_place": "ArrayLike<number>", "optional": f"{shown} | null", "required": shown}[one["role"]])
        results = []
        for one in outputs(function):
            kind = self.plain(self.element(one["type"])) if one["role"] not in ("out_bytes", "out_text") else ""
            results.append((one["name"], {"out": kind, "in_out": kind, "out_bytes": "Uint8Array", "out_text": "string"}.get(one["role"], f"{kind}[]")))
        returns = function["returns"]
        shown = "void" if returns["type"] in ("hh_result", "void") else self.plain(self.kind(returns))
        if len(results) == 1:
            shown = results[0][1]
        elif results:
            shown = "{ " + "; ".join(f"{name}: {kind}" for name, kind in results) + " }"
        return f"{self.method(function)}({', '.join(words)}): {shown};"


def write(description) -> dict[str, str]:
    js = JavaScript(description)
    return {"javascript/structs.js": js.structs_js(), "javascript/calls.js": js.calls_js(), "javascript/structs.d.ts": js.types()}
