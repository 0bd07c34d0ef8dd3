"""Runs the tests of the package beside this file with pytest; exit status 77 where something it needs is absent."""
import importlib.util
import pathlib
import sys

for needed in ("numpy", "pytest"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: {needed} is absent (Debian: python3-{needed})")
        sys.exit(77)

import pytest

sys.exit(pytest.main(["-q", "-ra", "-p", "no:cacheprovider", *(sys.argv[1:] or [str(pathlib.Path(__file__).parent)])]))
