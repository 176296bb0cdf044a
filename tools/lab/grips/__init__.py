"""Scores posed hands from meshes and capsules alone, independently of how they were posed."""
import sys

try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ImportError as missing:
    print(f"{sys.argv[0]}: needs Debian's python3-numpy and python3-scipy (tools/install_packages test): {missing}", file=sys.stderr)
    sys.exit(2)
