"""Judges chests, shoulders and elbows estimated from a head and two hands. Nothing here knows how they were estimated."""
import sys

try:
    import numpy  # noqa: F401
except ImportError as missing:
    print(f"{sys.argv[0]}: needs Debian's python3-numpy (tools/install_packages test): {missing}", file=sys.stderr)
    sys.exit(2)
