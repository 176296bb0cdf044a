"""A wheel with a shared library inside is for this platform only."""
from pathlib import Path

from setuptools import Distribution, setup


class Package(Distribution):
    def has_ext_modules(self):
        return any(one.suffix in (".so", ".dll", ".dylib") for one in Path("handhold").iterdir())


setup(distclass=Package)
