"""What pyproject.toml and CMakeLists.txt say of the project."""
from __future__ import annotations

import pathlib
import re
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def bindings() -> dict:
    """The Python package, with its version, which CMakeLists.txt states."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = re.search(r"project\(posewright VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())
    assert version is not None
    return {**project, "version": version[1]}


def program() -> dict:
    """The program as a Python package that brings it."""
    about = bindings()
    return {**about, "name": "posewright", "requires-python": ">=3.9", "dependencies": [],
            "description": "Plans which poses to measure before a robot is calibrated", "scripts": {"posewright": "posewright_program:main"}}
