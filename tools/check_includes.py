#!/usr/bin/env python3
"""Checks the include rules between folders (docs/conventions.md, "Folders"). Prints `file:line: rule` for each breach.

usage: tools/check_includes.py [ROOT]      exit status 0: none, 1: some
"""
import re
import sys
from pathlib import Path
from typing import Iterator, NamedTuple

# Folder of a file -> folders whose headers it may include. Inside systems/, system_rule() restricts this further.
ALLOWED_FOLDERS = {
    "engine": {"engine"},
    "components": {"components", "engine"},
    "systems": {"systems", "components", "engine"},
    "game": {"game", "systems", "components", "engine"},
    "tests": {"tests", "tools", "game", "systems", "components", "engine"},
    "tools": {"tools", "game", "systems", "components", "engine"},
}
# Trees whose folders must not include each other in a circle.
TREES_WITHOUT_CIRCLES = ("engine", "systems", "game")
# The product, in which each library is included in one place and our headers are named from the root. Tests and tools may use any library
# as an oracle.
PRODUCT_FOLDERS = {"engine", "components", "systems", "game"}
# The order of the stages, copies of all columns, and the public headers: these may use every system and the whole World.
FRONT_DOOR = re.compile(r"systems/(frame|snapshot|match|host)/.*")
NAMES_WORLD = re.compile(r"(systems/(frame|snapshot|match|host)/.*|components/world\w*\.[hc]pp|(game|tools|tests)/.*)")
# Headers that a host includes: systems/host/include is an include directory, so these are named `handhold/...`.
PUBLIC_HEADERS = "systems/host/include/"
# Files of the game that know the library by its public headers alone, as a stranger's game would: climbers, sessions, devices, runs, matches
# over a network and the loops of desktop and headset. Levels, pictures, inspector and reports use the columns.
PLAYS_THE_INTERFACE = re.compile(r"game/(climber|session|devices|run|play|desktop|headset|net)/.*|game/commands/play_files\.[hc]pp")
# The desktop and headset loops may name columns, which they draw. The other files may not.
NAMES_NO_COLUMNS = re.compile(r"game/(climber|session|devices|run|play|net)/.*")
COLUMNS = re.compile(r"(?<!hh::)\b(World|FrameCaches|StageStats|CollisionWorld|PlayerEntities|step_frame|hash_state|columns_of|entity_of|from_host)\b"
                     r"|\bscene_?(\(\))?\.(world|tuning|shapes|grip_meshes|caches|stats)\(\)")
# The progress of a level that loads has no place in the interface.
INTERFACE_EXCEPTIONS = {("game/play/loading.cpp", "engine/core/work_meter.hpp")}
# Public headers for source embedders: each counts as the private headers that it includes.
EMBEDDERS_HEADER = re.compile(r"handhold/(ecs|files|rigs|tuning)\.hpp")
# Includes of private headers in game/, which may only become fewer.
MOST_PRIVATE_INCLUDES_OF_GAME = 186
PRIVATE_HEADER = re.compile(r"(engine|components|systems)/.*")
# Words of the player's body that engine code must not use in identifiers.
ENGINE_FOREIGN = re.compile(r"(?<![A-Za-z])(?:player|hand|hands|finger|fingers|palm|thumb)(?![a-z])|(?:Player|Hand|Finger|Palm|Thumb)(?![a-z])")


class Library(NamedTuple):
    name: str
    header: re.Pattern  # of the included path
    identifier: re.Pattern | None  # in code; None: its types may be named anywhere
    home: re.Pattern  # the files that may use it
    home_text: str


def library(name: str, header: str, identifier: str | None, home: str, home_text: str) -> Library:
    return Library(name, re.compile(header), re.compile(identifier) if identifier else None, re.compile(home), home_text)


LIBRARIES = [
    library("Bullet", r"bullet/|bt[A-Z]\w*\.h|BulletCollision/|LinearMath/", r"\bbt[A-Z]\w+",
            r"engine/collision/bullet_\w+\.[ch]pp", "engine/collision/bullet_*"),
    library("Box2D", r"box2d/", r"\bb2[A-Z]\w+",
            r"engine/geometry/disc_contact_box2d\.cpp", "engine/geometry/disc_contact_box2d.cpp"),
    library("TBB", r"tbb/|oneapi/", r"\btbb::", r"engine/core/parallel_pool\.cpp", "engine/core/parallel_pool.cpp"),
    library("Draco", r"draco/", r"\bdraco::", r"engine/io/gltf_draco\.cpp", "engine/io/gltf_draco.cpp"),
    library("meshoptimizer", r"meshoptimizer", r"\bmeshopt_\w+",
            r"engine/geometry/simplify_meshopt\.cpp|engine/io/gltf_meshopt\.cpp",
            "engine/geometry/simplify_meshopt.cpp and engine/io/gltf_meshopt.cpp"),
    library("Eigen", r"(unsupported/)?Eigen/", None, r"engine/math/math\.hpp", "engine/math/math.hpp"),
    library("OpenXR", r"openxr/", r"\b[xX]r[A-Z]\w+", r"game/xr/.*", "game/xr/"),
    library("libwebsockets", r"libwebsockets", r"\blws_?[a-z]\w*|\bLWS_\w+", r"game/net/websocket_\w+\.[ch]pp", "game/net/websocket_*"),
    library("ngtcp2", r"ngtcp2/", r"\bngtcp2_\w+|\bNGTCP2_\w+", r"game/net/quic_\w+\.[ch]pp", "game/net/quic_*"),
    library("GnuTLS", r"gnutls/", r"\bgnutls_\w+|\bGNUTLS_\w+", r"game/net/(quic_tls\.[ch]pp|quic_callbacks\.cpp|hmac_gnutls\.cpp)",
            "game/net/quic_tls.* and hmac_gnutls.cpp"),
    library("zstd", r"zstd", r"\bZSTD_\w+", r"game/net/pack_state_zstd\.cpp", "game/net/pack_state_zstd.cpp"),
    library("OpenSSL", r"openssl/", None, r"game/net/hmac_openssl\.cpp", "game/net/hmac_openssl.cpp"),
    library("SDL", r"SDL", r"\bSDL_\w+", r"game/desktop/window\.cpp", "game/desktop/window.cpp"),
    library("Dear ImGui", r"imgui", r"\bIm(Gui|Vec2|Vec4|Draw|Font)\w*", r"game/ui/.*", "game/ui/"),
    library("OpenGL", r"(GL|GLES\d|EGL|KHR|epoxy)/", None, r"game/(render|xr)/.*", "game/render/ and game/xr/"),
]

# Comments become blanks; literals keep only their quotes. Line breaks stay, so line numbers stay correct.
TOKEN = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?\*/)'
    r'|(?P<raw>R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)")'
    r'|(?P<literal>"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\')', re.DOTALL)
INCLUDE = re.compile(r'\s*#\s*include\s*(?P<mark>[<"])(?P<path>[^>"]+)[>"]')


class Breach(NamedTuple):
    file: str
    line: int
    rule: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.rule}"


def blank(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


def without_comments(text: str) -> str:
    return TOKEN.sub(lambda m: blank(m[0]) if m["comment"] else m[0], text)


def without_literals(text: str) -> str:
    return TOKEN.sub(lambda m: blank(m[0]), text)


def may_include_system(file: str, path: str) -> bool:
    """Whether `file` in systems/ may include the header `path` of systems/."""
    if path == str(Path(file).with_suffix(".hpp")) or FRONT_DOOR.fullmatch(file):
        return True
    target_folder = str(Path(path).parent)
    if target_folder == "systems/rigs":
        return True
    area = "/".join(file.split("/")[:2])
    return not file.startswith("systems/rigs/") and target_folder == f"{area}/shared"


def include_rules(file: str, mark: str, path: str) -> Iterator[str]:
    """The rules that the include of `path` in `file` breaks."""
    folder = file.split("/")[0]
    target = path.split("/")[0]
    if PLAYS_THE_INTERFACE.fullmatch(file) and (PRIVATE_HEADER.fullmatch(path) or EMBEDDERS_HEADER.fullmatch(path)):
        if (file, path) not in INTERFACE_EXCEPTIONS:
            yield f'"{path}": this file plays the interface, by handhold.h, handhold.hpp and math.hpp'
    if target not in ALLOWED_FOLDERS:
        if folder not in PRODUCT_FOLDERS:
            return  # a library, or a helper next to a test
        if mark == '"':
            yield f'"{path}": paths of our headers start at the root; a library\'s header goes in <>'
        for lib in LIBRARIES:
            if lib.header.match(path) and not lib.home.fullmatch(file):
                yield f"<{path}>: only {lib.home_text} includes {lib.name}"
        return
    if mark == "<":
        yield f'<{path}>: our own headers go in ""'
    if target not in ALLOWED_FOLDERS[folder]:
        yield f'"{path}": {folder} does not include {target}'
    if folder == target == "systems" and not may_include_system(file, path):
        yield (f'"{path}": a system includes its own header, its area\'s shared/ and rigs/, and no other system;'
               " only systems/frame/frame, systems/snapshot/snapshot and systems/host do")


def code_rules(file: str, line: str) -> Iterator[str]:
    """The rules that one line of code, without comments and literals, breaks."""
    if re.search(r"\bWorld\b", line) and not NAMES_WORLD.fullmatch(file):
        yield "World: only components/world, systems/frame/frame, systems/snapshot/snapshot, game, tools and tests name it"
    column = COLUMNS.search(line) if NAMES_NO_COLUMNS.fullmatch(file) else None
    if column:
        yield f"{column[0]}: this file plays the interface and names no column"
    if file.split("/")[0] not in PRODUCT_FOLDERS:
        return
    for lib in LIBRARIES:
        found = lib.identifier.search(line) if lib.identifier else None
        if found and not lib.home.fullmatch(file):
            yield f"{found[0]}: only {lib.home_text} names {lib.name}"


def breaches_of(file: str, text: str) -> Iterator[Breach]:
    """`file` relative to the root, with forward slashes."""
    code = without_comments(text)
    if file.endswith(".hpp") and not re.search(r"^\s*#\s*pragma\s+once\b", code, re.MULTILINE):
        yield Breach(file, 1, "no #pragma once")
    bare = without_literals(text).split("\n")
    for number, line in enumerate(code.split("\n"), start=1):
        include = INCLUDE.match(line)
        rules = include_rules(file, include["mark"], include["path"]) if include else code_rules(file, bare[number - 1])
        for rule in rules:
            yield Breach(file, number, rule)


def folder_of(path: str, depth: int) -> str:
    """The folder of a file, cut to `depth` names."""
    return "/".join(path.split("/")[:-1][:depth])


def find_circle(start: str, edges: dict[str, dict[str, tuple]]) -> list[str]:
    """The shortest path of folders from `start` back to it, both ends included; empty if there is none."""
    came_from = {}
    queue = [start]
    for folder in queue:
        for target in edges.get(folder, {}):
            if target == start:
                path = [start, folder]
                while folder != start:
                    folder = came_from[folder]
                    path.append(folder)
                return path[::-1]
            if target not in came_from:
                came_from[target] = folder
                queue.append(target)
    return []


def circles_of(includes: list[tuple[str, int, str]]) -> Iterator[Breach]:
    """One breach for each circle of folders, at its folders' first include of the next. Areas (engine/solver) and the folders inside them
    (engine/solver/model) are checked separately: either may have a circle that the other does not show."""
    named = set()
    for depth in (2, 3):
        edges: dict[str, dict[str, tuple[str, int]]] = {}
        for file, line, path in includes:
            source, target = folder_of(file, depth), folder_of(path, depth)
            if source != target:
                edges.setdefault(source, {}).setdefault(target, (file, line))
        for start in sorted(edges):
            circle = find_circle(start, edges)
            if circle and frozenset(circle) not in named:
                named.add(frozenset(circle))
                places = ["%s:%d" % edges[a][b] for a, b in zip(circle, circle[1:])]
                file, line = edges[circle[0]][circle[1]]
                yield Breach(file, line, f"circle of folders: {' -> '.join(circle)} ({', '.join(places)})")


def private_headers_of(root: Path, public: str) -> int:
    """How many private headers a public header includes, itself or by other public headers."""
    path = root / PUBLIC_HEADERS / public
    if not path.is_file():
        return 0
    count = 0
    for line in without_comments(path.read_text(encoding="utf-8")).split("\n"):
        include = INCLUDE.match(line)
        if include and PRIVATE_HEADER.fullmatch(include["path"]):
            count += 1
        elif include and EMBEDDERS_HEADER.fullmatch(include["path"]):
            count += private_headers_of(root, include["path"])
    return count


def count_private_includes(root: Path) -> int:
    """Includes of private headers in game/, with those behind the headers for source embedders."""
    count = 0
    for path in sorted((root / "game").rglob("*.[hc]pp")):
        for line in without_comments(path.read_text(encoding="utf-8")).split("\n"):
            include = INCLUDE.match(line)
            if include and PRIVATE_HEADER.fullmatch(include["path"]):
                count += 1
            elif include and EMBEDDERS_HEADER.fullmatch(include["path"]):
                count += private_headers_of(root, include["path"])
    return count


def check_tree(root: Path) -> list[Breach]:
    breaches = []
    includes: dict[str, list[tuple[str, int, str]]] = {tree: [] for tree in TREES_WITHOUT_CIRCLES}
    for folder in ALLOWED_FOLDERS:
        for path in sorted((root / folder).rglob("*.[hc]pp")):
            file = path.relative_to(root).as_posix()
            text = path.read_text(encoding="utf-8")
            breaches.extend(breaches_of(file, text))
            if folder in includes:
                for number, line in enumerate(without_comments(text).split("\n"), start=1):
                    include = INCLUDE.match(line)
                    if include and include["path"].startswith(folder + "/"):
                        includes[folder].append((file, number, include["path"]))
    for tree in includes.values():
        breaches.extend(circles_of(tree))
    count = count_private_includes(root)
    if count > MOST_PRIVATE_INCLUDES_OF_GAME:
        breaches.append(Breach("game", 0, f"{count} includes of private headers, at most {MOST_PRIVATE_INCLUDES_OF_GAME}: use handhold.hpp"))
    return breaches


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    if not (root / "engine").is_dir():
        print(f"check_includes: {root}: no folder engine/ here", file=sys.stderr)
        return 1
    breaches = check_tree(root)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
