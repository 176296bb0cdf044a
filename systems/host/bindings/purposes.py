"""What a parameter or a field of the C interface is for, so that each language can offer lists, texts and return values."""
import re

from parse_headers import Description, HeaderError

# Bytes of each scalar type; 0: as many as a pointer has.
SCALARS = {"double": 8, "float": 4, "int32_t": 4, "uint32_t": 4, "uint64_t": 8, "uint8_t": 1, "size_t": 0, "char": 1, "void": 0}

# Array fields with more than one element per count: struct.field -> (field with the count, elements per count).
COUNTED_FIELDS = {"hh_mesh_def.positions": ("vertex_count", 3)}


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
