"""Reads the C interface (systems/host/include/handhold/*.h) into a description that generators and handhold.json share.

The headers are a subset of C99: enums, structs, opaque structs, function pointers, functions, numeric constants and comments. Everything else,
and every parameter whose purpose is not clear from its type and the function's comment, is an error: extend parse_headers.py or purposes.py, or
write the header as the others. The comment says what a type cannot:
    `NAME`: HH_X_COUNT elements     the parameter points to so many
    null                            the function's pointer to a const struct may be null (definitions: by their type)
    `NAME`, not null                it may not

A comment before a declaration documents it; a comment behind a field or an enumerator documents that.
"""
from pathlib import Path

from parse_headers import Description, HeaderError, Reader, tokens_of
from purposes import SCALARS, Purposes

HEADERS = ("version.h", "base.h", "convert.h", "world.h", "level.h", "players.h", "skeletons.h", "your_physics.h", "match.h")


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
