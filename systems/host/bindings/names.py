"""Names and texts that all languages share."""


def words(c_name: str) -> list[str]:
    return c_name.removeprefix("hh_").split("_")


def pascal(c_name: str) -> str:
    """hh_body_def -> BodyDef."""
    return "".join(word[:1].upper() + word[1:] for word in words(c_name))


def method(function: dict) -> str:
    """hh_world_events_sized -> events, hh_match_packet_to -> packet_to, hh_body_add -> body_add."""
    owner = self_of(function).removeprefix("hh_")
    return function["name"].removeprefix("hh_").removesuffix("_sized").removeprefix(f"{owner}_")


def camel(snake: str) -> str:
    first, *others = snake.split("_")
    return first + "".join(word[:1].upper() + word[1:] for word in others)


def enum_prefix(enum: dict) -> str:
    """What all values begin with: HH_GRIP_ of hh_grip_kind, HH_ of hh_result."""
    prefix = "HH_"
    while True:
        following = {value["name"][len(prefix):].partition("_")[0] for value in enum["values"]}
        longer = prefix + next(iter(following)) + "_"
        if len(following) != 1 or not all(len(value["name"]) > len(longer) for value in enum["values"]):
            return prefix
        prefix = longer


def self_of(function: dict) -> str:
    """The handle that a function belongs to: hh_world, hh_mesh, or nothing."""
    return next((p["type"] for p in function["params"] if p.get("role") == "self"), "")


def given(function: dict) -> list[dict]:
    """Parameters that the caller of a wrapper gives."""
    params = [p for p in function["params"] if p.get("role") in ("value", "handle", "text", "bytes", "array", "in_place", "optional", "required")]
    own = [p for p in function["params"] if p.get("role") == "out_array" and is_own_count(function, p)]
    return params + [{"name": p["count"], "type": "size_t", "pointer": 0, "const": False, "role": "own_count"} for p in own]


def has_callbacks(struct: dict, callbacks: set[str]) -> bool:
    """True for structs of functions that the library calls: delegates and contexts must live as long as it may call them."""
    return any(part["type"] in callbacks for part in struct["fields"])


def is_own_count(function: dict, param: dict) -> bool:
    """True for an array that the function fills, whose length the caller must give: no other array of the call has it."""
    return "count" in param and not any(p.get("role") == "array" and p.get("count") == param["count"] for p in function["params"])


def outputs(function: dict) -> list[dict]:
    """Parameters that a wrapper returns."""
    roles = ("out", "in_out", "out_list", "out_bytes", "out_view", "out_text", "out_array", "in_place", "out_handle")
    return [p for p in function["params"] if p.get("role") in roles]


def is_raw_only(function: dict) -> bool:
    """Functions that wrappers offer by hand: creation, destruction and defaults."""
    return "default_of" in function or function["name"] in (
        "hh_world_create", "hh_world_destroy", "hh_mesh_create", "hh_mesh_destroy", "hh_match_create", "hh_match_destroy", "hh_last_error")
