"""Scores chests, shoulders and elbows that were estimated from a head and two hands, independently of the estimator."""
import sys

try:
    import numpy  # noqa: F401
except ImportError as missing:
    print(f"{sys.argv[0]}: needs Debian's python3-numpy (tools/install_packages test): {missing}", file=sys.stderr)
    sys.exit(2)
