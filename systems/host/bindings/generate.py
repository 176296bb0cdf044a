#!/usr/bin/env python3
"""Generates the bindings of the C interface from its headers: handhold.json, C#, Python and JavaScript.

usage: systems/host/bindings/generate.py [--check]
    --check: writes nothing; exit status 1, with the names of the files, if one differs from what the headers say
"""
import json
import sys
from pathlib import Path

import read_headers
import write_csharp
import write_javascript
import write_python

HERE = Path(__file__).resolve().parent
INCLUDE = HERE.parent / "include"
FORMAT = 1  # of handhold.json; raised if a field changes its meaning


def json_of(description: read_headers.Description) -> str:
    """One line for each declaration, so that changes of the interface are changes of lines."""
    layouts = {"wasm32": read_headers.layout(description, 4), "64": read_headers.layout(description, 8)}
    structs = []
    for struct in description.structs:
        made = {**struct, "layout": {}}
        for name, layout in layouts.items():
            one = layout[struct["name"]]
            made["layout"][name] = {"size": one["size"], "align": one["align"], "offsets": list(one["offsets"].values())}
        structs.append(made)
    version = {one["name"].removeprefix("HANDHOLD_VERSION_").lower(): one["value"] for one in description.constants if "_VERSION_" in one["name"]}
    sections = {"constants": description.constants, "enums": description.enums, "handles": description.handles,
                "callbacks": description.callbacks, "structs": structs, "functions": description.functions}
    texts = [f'"format": {FORMAT}', f'"version": {json.dumps(version["text"])}']
    for name, entries in sections.items():
        texts.append(f'"{name}": [\n' + ",\n".join(json.dumps(one, ensure_ascii=False) for one in entries) + "\n]")
    return "{\n" + ",\n".join(texts) + "\n}\n"


def outputs() -> dict[str, str]:
    """Contents by path below this folder."""
    description = read_headers.read(INCLUDE)
    made = {"handhold.json": json_of(description)}
    for writer in (write_csharp, write_python, write_javascript):
        made |= writer.write(description)
    return made


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        made = outputs()
    except read_headers.HeaderError as error:
        print(f"generate: {error}", file=sys.stderr)
        return 1
    stale = [name for name, text in made.items() if not (HERE / name).is_file() or (HERE / name).read_text(encoding="utf-8") != text]
    if sys.argv[1:] == ["--check"]:
        for name in stale:
            print(f"systems/host/bindings/{name} is stale: run systems/host/bindings/generate.py", file=sys.stderr)
        return 1 if stale else 0
    for name in stale:
        (HERE / name).parent.mkdir(parents=True, exist_ok=True)
        (HERE / name).write_text(made[name], encoding="utf-8")
        print(f"wrote {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
