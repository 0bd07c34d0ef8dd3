"""What pip calls (PEP 517) for `pip install .`: CMake builds and installs the Python package into a folder, which becomes a wheel on
the libraries of this machine.

Setting (`pip install --config-settings built=FOLDER .`): take the package of this build folder as it is; otherwise build/wheel is
configured and built."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile

import project
import wheel_file


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None) -> str:
    """Writes the wheel into wheel_directory and returns its name."""
    settings = dict(config_settings or {})
    if not set(settings) <= {"built"}:
        raise SystemExit(f"unknown settings {sorted(set(settings) - {'built'})}; there is built=FOLDER")
    with tempfile.TemporaryDirectory() as name:
        content = pathlib.Path(name)
        package = install_bindings(pathlib.Path(settings["built"]) if "built" in settings else _build(project.ROOT / "build" / "wheel"), content)
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        if not (package / f"_core{suffix}").exists():
            raise SystemExit(f"{settings.get('built')} was built for {next(package.glob('_core*.so')).name}, not for {sys.executable} ({suffix})")
        abi = f"cp{sys.version_info.major}{sys.version_info.minor}"
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        return wheel_file.write(content, pathlib.Path(wheel_directory), project.bindings(), project.ROOT, f"{abi}-{abi}-{platform}", {})


def build_sdist(sdist_directory, config_settings=None) -> str:
    raise SystemExit("posewright is built from its whole source folder; there is no source distribution")


def install_bindings(build: pathlib.Path, content: pathlib.Path) -> pathlib.Path:
    """The Python package as CMake installs it, in the empty folder `content`; returns its folder there."""
    if not (build / "CMakeCache.txt").exists():
        raise SystemExit(f"{build} is no build folder")
    with tempfile.TemporaryDirectory() as name:
        run("cmake", "--install", build, "--component", "python", "--prefix", name, "--strip")
        found = list(pathlib.Path(name).rglob("posewright/__init__.py"))
        if not found:
            raise SystemExit(f"{build} was configured without -DPOSEWRIGHT_BUILD_PYTHON=ON")
        return shutil.move(found[0].parent, content / "posewright")


def _build(folder: pathlib.Path) -> pathlib.Path:
    run("cmake", "-S", project.ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
        "-DPOSEWRIGHT_BUILD_TESTS=OFF", "-DPOSEWRIGHT_BUILD_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}")
    run("cmake", "--build", folder, "--target", "posewright_python")
    return folder


def run(*words) -> None:
    # What pip sets for its own modules is no business of CMake's helpers.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    subprocess.run([str(word) for word in words], check=True, env=environment, stdout=sys.stderr)
