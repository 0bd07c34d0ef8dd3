import os
import re
import shutil
import subprocess
import sys

import pytest

import posewright as pw
from conftest import ROOT


def test_the_package_description_is_sound():
    tomllib = pytest.importorskip("tomllib", reason="Python is older than 3.11")
    described = tomllib.loads((ROOT / "pyproject.toml").read_text())
    version = re.search(r"project\(posewright VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    assert described["project"]["dynamic"] == ["version"] and version == pw.__version__
    system = described["build-system"]
    assert (ROOT / system["backend-path"][0] / f"{system['build-backend']}.py").exists()
    assert system["requires"] == []  # no index is asked


def test_an_installed_package_is_whole_and_plans(examples, tmp_path):
    build = os.environ.get("POSEWRIGHT_BUILD")
    if build is None or shutil.which("cmake") is None:
        pytest.skip("POSEWRIGHT_BUILD does not name a build folder")
    subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", tmp_path], check=True,
                   capture_output=True)
    (package,) = tmp_path.glob("lib/python*/dist-packages")
    assert [path.name for path in package.iterdir()] == ["posewright"]
    names = {path.name for path in (package / "posewright").iterdir()}
    assert {"__init__.py", "_core.pyi", "py.typed"} < names
    sources = {path.name for path in (ROOT / "python" / "posewright").iterdir() if path.is_file()}
    assert sources < names and len(names - sources) == 1  # the compiled part
    script = "import posewright as pw, sys; print(pw.__file__, len(pw.plan(pw.Problem(sys.argv[1]), candidates=60, method=\"greedy\")))"
    done = subprocess.run([sys.executable, "-c", script, str(examples / "kr270" / "problem.yaml")], cwd=tmp_path,
                          env={"PYTHONPATH": str(package)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(package / "posewright" / "__init__.py"), "18"]
