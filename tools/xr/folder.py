"""A Debian 13 in a folder, with Monado: Debian 12 has OpenXR's loader but no runtime. Made once and kept; about 1 GB."""
import os
import shutil
import subprocess
import time
from pathlib import Path

SUITE = "trixie"
# The runtime; what draws for it and for the game without a graphics card; a layer that writes down the game's calls.
PACKAGES = ["monado-service", "libopenxr1-monado", "mesa-vulkan-drivers", "libegl1", "libgl1-mesa-dri", "libgl1", "libepoxy0",
            "libsdl2-2.0-0", "libopenxr-loader1", "openxr-layer-apidump"]
MARK = "etc/handhold_xr"  # holds the packages that the folder was made with
LIBRARIES = "opt/handhold"
LIBRARY_PLACES = ("usr/lib/x86_64-linux-gnu", "usr/lib/aarch64-linux-gnu", "usr/lib64", "usr/lib")


NAMESPACE = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]


class CannotMake(Exception):
    """Why there is no such folder here, in one line."""


def default_folder() -> Path:
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "handhold" / "xr-debian13"


def mirror() -> str:
    """Where this machine's own packages come from."""
    targets = subprocess.run(["apt-get", "indextargets", "--format", "$(ORIGIN)|$(LABEL)|$(REPO_URI)", "Created-By: Packages"],
                             capture_output=True, text=True, check=False).stdout
    for line in targets.splitlines():
        origin, label, uri = line.split("|", 2)
        if origin == "Debian" and label == "Debian":
            return uri
    raise CannotMake("this machine's apt has no Debian sources to make a Debian 13 folder from")


def ensure(folder: Path) -> float:
    """Makes the folder if it is not there; how many seconds that took."""
    mark = folder / MARK
    if mark.is_file() and mark.read_text().split() == PACKAGES:
        return 0.0
    for tool in ("debootstrap", "unshare", "apt-get"):
        if shutil.which(tool) is None:
            raise CannotMake(f"no {tool} on this machine")
    begin = time.monotonic()
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = folder.with_name(folder.name + ".part")
    if part.exists():
        shutil.rmtree(part)
    print(f"xr_e2e: making {folder}: a few minutes, 1 GB", flush=True)
    log = folder.with_name(folder.name + ".log")
    with log.open("w") as out:
        # In a mount namespace of its own: what debootstrap mounts in the folder is gone with it, however it ends.
        made = subprocess.run([*NAMESPACE, "debootstrap", "--variant=minbase", f"--include={','.join(PACKAGES)}", SUITE, str(part), mirror()],
                              stdout=out, stderr=subprocess.STDOUT, check=False)
    if made.returncode != 0:
        raise CannotMake(f"debootstrap fails (no network?): {log}")
    shutil.rmtree(part / "var/cache/apt/archives", ignore_errors=True)
    for place in (LIBRARIES, "game", "scenes", "out"):
        (part / place).mkdir(parents=True, exist_ok=True)
    (part / MARK).write_text("\n".join(PACKAGES) + "\n")
    if folder.exists():
        shutil.rmtree(folder)
    part.rename(folder)
    return time.monotonic() - begin


def lend_libraries(folder: Path, program: Path) -> list[str]:
    """Copies what the program links and Debian 13 has under another name, or not at all, beside the folder's own libraries."""
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
