"""The stubs say what there is, no more and no less."""
import ast
import importlib.util
import inspect
import os
import pathlib
import subprocess
import sys

import pytest

import posewright
from conftest import ROOT
from posewright import _core

STUBS = ast.parse(pathlib.Path(_core.__file__).with_name("_core.pyi").read_text())
# Of classes: what the language gives every object.
COMMON = {"__init__", "__dict__", "__repr__", "__module__", "__doc__", "__new__", "__weakref__"}


def members(value):
    return {name for name in vars(value) if not name.startswith("_pybind11") and name not in COMMON}


def stub_members(node):
    return {n.name for n in node.body if isinstance(n, ast.FunctionDef)} - COMMON


def test_every_public_name_of_the_compiled_part_has_a_stub_and_back():
    stubbed = {n.name: n for n in STUBS.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))}
    there = {name: value for name, value in vars(_core).items() if not name.startswith("__")}
    assert set(stubbed) == set(there)
    for name, value in there.items():
        if inspect.isclass(value) and not issubclass(value, Exception):
            assert stub_members(stubbed[name]) == members(value), name


def test_stubs_name_the_arguments_and_which_need_their_name():
    for node in STUBS.body:
        if isinstance(node, ast.FunctionDef) and node.args.args:
            signature = getattr(_core, node.name).__doc__.splitlines()[0]
            names = [a.arg for a in node.args.args] + ["*"] * bool(node.args.kwonlyargs)
            names += [a.arg for a in node.args.kwonlyargs]
            written = [part.split(":")[0].strip() for part in arguments(signature)]
            assert written == names, node.name


def test_every_option_of_a_command_is_a_keyword_of_its_function():
    program = os.environ.get("POSEWRIGHT_PROGRAM")
    if program is None:
        pytest.skip("POSEWRIGHT_PROGRAM does not name the program")
    done = subprocess.run([ROOT / "scripts" / "count-structure", program], capture_output=True, text=True, check=True,
                          env={**os.environ, "PYTHONPATH": str(pathlib.Path(posewright.__file__).parents[1])})
    assert done.stdout.splitlines()[-1].startswith("options missing in Python: 0:"), done.stdout.splitlines()[-1]


def arguments(signature):
    """The arguments of a signature as pybind11 writes it, without commas inside brackets."""
    inside, depth, parts = signature[signature.index("(") + 1 : signature.rindex(") ->")], 0, [""]
    for c in inside:
        depth += (c in "[(") - (c in ")]")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return parts


def test_the_package_lists_what_it_has():
    public = {name for name in vars(posewright) if not name.startswith("_")} - {"annotations"}
    modules = {name for name in public if inspect.ismodule(getattr(posewright, name))}
    assert public - modules == set(posewright.__all__) - {"__version__"}
    missing = {name for name in vars(_core) if not name.startswith("_")} - set(posewright.__all__)
    assert not missing
    for name in posewright.__all__:
        assert name == "__version__" or inspect.getdoc(getattr(posewright, name)), name


def test_types_pass_mypy(tmp_path):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("mypy is absent (Debian: python3-mypy)")
    script = tmp_path / "user.py"
    script.write_text(USER)
    source, built = ROOT / "python" / "posewright", pathlib.Path(posewright.__file__).parent
    # Classes of pybind11 have a metaclass of their own, and __init__ takes anything where there is none.
    allowed = tmp_path / "allowed"
    allowed.write_text(r"posewright\._core\.[A-Z]\w*(\.__init__)?")
    for command in (
        ["mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), str(source), str(script)],
        ["mypy.stubtest", "posewright._core", "--allowlist", str(allowed)],
    ):
        done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, cwd=tmp_path,
                              env={"MYPYPATH": str(source.parent), "PYTHONPATH": str(built.parent), "PATH": "/usr/bin"})
        assert done.returncode == 0, done.stdout + done.stderr


USER = """
import numpy as np
import posewright as pw

problem = pw.Problem("problem.yaml")
plan: pw.Plan = pw.plan(problem, poses=18, progress=lambda p: print(p.stage))
rows: int = plan.configurations.shape[0]
pw.evaluate(problem, plan.configurations, drop=1).scores["o1"].value + 1.0
pw.log_det(pw.blocks(problem, plan), [1, 2])
pw.select(np.zeros((3, 2, 1)), poses=2, repeats="allow").save("plan.json")
for name, observation in pw.observe(problem).items():
    print(name.upper(), observation.rank + 1)
"""
