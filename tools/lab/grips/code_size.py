"""Size of the code that shows a gripping hand: lines, state and tuning values, counted in the sources."""
import re

# Hand stages, and what they alone use.
SOURCES = ("systems/hand/*.?pp", "systems/hand/shared/*.?pp", "components/hand_scratch.hpp", "components/hand_surroundings.hpp",
           *(f"engine/geometry/{name}.?pp" for name in ("chain_fit", "chain_patch", "closing_chain", "disc_contact", "disc_cut", "disc_gap",
                                                        "disc_trace", "edge_pairs", "hinge_chain", "plane_cut4", "reach_slab", "segment_distances4")))
STATE = ("GripSurface", "PalmOffset", "FingerPose")  # components/hand.hpp
TUNING = ("PalmTuning", "FingerTuning", "ThumbTuning")  # components/tuning.hpp


def members(text, name):
    """Number of data members of `struct name`, which has no member functions. Raises ValueError if there is no such struct."""
    found = re.search(rf"^struct {name} {{\n(.*?)^}};", text, re.MULTILINE | re.DOTALL)
    if not found:
        raise ValueError(f"expected struct {name}")
    code = re.sub(r"//[^\n]*", "", found.group(1))
    return sum(";" in line and not re.match(r"\s*static ", line) for line in code.splitlines())


def count(root):
    """{lines, state, tuning} of a source tree; None if it has no sources."""
    sources = [path for pattern in SOURCES for path in sorted(root.glob(pattern))]
    if not sources:
        return None
    hand, tuning = ((root / "components" / name).read_text(encoding="utf-8") for name in ("hand.hpp", "tuning.hpp"))
    return {"lines": sum(len(path.read_text(encoding="utf-8").splitlines()) for path in sources),
            "state": sum(members(hand, name) for name in STATE), "tuning": sum(members(tuning, name) for name in TUNING)}
