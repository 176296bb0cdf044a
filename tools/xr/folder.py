"""A Debian 13 in a folder, with Monado: Debian 12 has OpenXR's loader but no runtime. Made once and kept; about 1 GB.

Only folders with the marker file MARK are ever written to or deleted: the tool runs as root and --folder may name any place.
"""
import os
import shutil
import subprocess
import time
from pathlib import Path

SUITE = "trixie"
# The runtime; what draws for it and for the game without a graphics card; a layer that writes down the game's calls.
PACKAGES = ["monado-service", "libopenxr1-monado", "mesa-vulkan-drivers", "libegl1", "libgl1-mesa-dri", "libgl1", "libepoxy0",
            "libsdl2-2.0-0", "libopenxr-loader1", "openxr-layer-apidump"]
MARK = "etc/handhold_xr"  # the marker; once the folder is complete it lists the packages in it
LIBRARIES = "opt/handhold"
LIBRARY_PLACES = ("usr/lib/x86_64-linux-gnu", "usr/lib/aarch64-linux-gnu", "usr/lib64", "usr/lib")


NAMESPACE = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]


class CannotMake(Exception):
    """The reason why the folder cannot be made on this machine, in one line."""


class NotOurs(Exception):
    """The folder, or its neighbour .part, exists and this tool did not make it."""


def is_marked(folder: Path) -> bool:
    mark = folder / MARK
    return folder.is_dir() and not folder.is_symlink() and mark.is_file() and not mark.is_symlink()


def refuse_foreign(folder: Path) -> None:
    """Raises NotOurs unless the path is free or a folder that this tool marked."""
    if folder.parent == folder or (os.path.lexists(folder) and not is_marked(folder)):
        raise NotOurs(f"{folder} exists and was not made by xr_e2e: name a folder that does not exist")


def part_of(folder: Path) -> Path:
    """The path where the folder is made; it is renamed when complete."""
    return folder.with_name(folder.name + ".part")


def remove(folder: Path) -> None:
    refuse_foreign(folder)
    if folder.exists():
        shutil.rmtree(folder)


def default_folder() -> Path:
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "handhold" / "xr-debian13"


def mirror() -> str:
    """The URI that this machine's own packages come from."""
    targets = subprocess.run(["apt-get", "indextargets", "--format", "$(ORIGIN)|$(LABEL)|$(REPO_URI)", "Created-By: Packages"],
                             capture_output=True, text=True, check=False).stdout
    for line in targets.splitlines():
        origin, label, uri = line.split("|", 2)
        if origin == "Debian" and label == "Debian":
            return uri
    raise CannotMake("this machine's apt has no Debian sources to make a Debian 13 folder from")


def ensure(folder: Path) -> float:
    """Makes the folder unless it is complete. Returns the seconds that took. Raises NotOurs before anything is touched."""
    refuse_foreign(folder)
    refuse_foreign(part_of(folder))
    mark = folder / MARK
    if mark.is_file() and mark.read_text().split() == PACKAGES:
        return 0.0
    for tool in ("debootstrap", "unshare", "apt-get"):
        if shutil.which(tool) is None:
            raise CannotMake(f"no {tool} on this machine")
    begin = time.monotonic()
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = part_of(folder)
    remove(part)
    (part / MARK).parent.mkdir(parents=True)
    (part / MARK).write_text("incomplete\n")
    print(f"xr_e2e: making {folder}: a few minutes, 1 GB", flush=True)
    log = part / "xr_e2e.log"
    with log.open("w") as out:
        # A mount namespace of its own ends with debootstrap, and what debootstrap mounted in the folder ends with it.
        made = subprocess.run([*NAMESPACE, "debootstrap", "--variant=minbase", f"--include={','.join(PACKAGES)}", SUITE, str(part), mirror()],
                              stdout=out, stderr=subprocess.STDOUT, check=False)
    if made.returncode != 0:
        raise CannotMake(f"debootstrap fails (no network?): {log}")
    shutil.rmtree(part / "var/cache/apt/archives", ignore_errors=True)
    for place in (LIBRARIES, "game", "scenes", "out"):
        (part / place).mkdir(parents=True, exist_ok=True)
    (part / MARK).write_text("\n".join(PACKAGES) + "\n")
    remove(folder)
    part.rename(folder)
    return time.monotonic() - begin


def lend_libraries(folder: Path, program: Path) -> list[str]:
    """Copies the libraries that the program needs and the folder lacks into the folder."""
    listed = subprocess.run(["ldd", str(program)], capture_output=True, text=True, check=True).stdout
    lent = []
    for line in listed.splitlines():
        words = line.split()
        if len(words) < 3 or words[1] != "=>" or any((folder / place / words[0]).exists() for place in LIBRARY_PLACES):
            continue
        if words[2] == "not":
            raise CannotMake(f"{program} lacks {words[0]}")
        shutil.copy(words[2], folder / LIBRARIES / words[0])
        lent.append(words[0])
    return lent
