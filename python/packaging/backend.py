"""What pip calls (PEP 517): CMake builds and installs the package into a folder, which becomes a wheel.

Settings, each as `pip install --config-settings NAME=VALUE .`:
  built=FOLDER   take the package of this build folder as it is; otherwise build/wheel is configured and built
  repair=yes     put the shared libraries of other packages into the wheel, so that it runs without them (repair.py)
"""
from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import sysconfig
import tempfile
import tomllib

import repair
import wheel_file

ROOT = pathlib.Path(__file__).resolve().parents[2]
SETTINGS = {"built", "repair"}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None) -> str:
    """Writes the wheel into wheel_directory and returns its name."""
    settings = dict(config_settings or {})
    if not set(settings) <= SETTINGS:
        raise SystemExit(f"unknown settings {sorted(set(settings) - SETTINGS)}; there are {sorted(SETTINGS)}")
    if settings.get("repair", "no") not in ("yes", "no"):
        raise SystemExit(f"repair is {settings['repair']!r}; yes and no are allowed")
    with tempfile.TemporaryDirectory() as name:
        content = pathlib.Path(name) / "content"
        _install(settings.get("built"), pathlib.Path(name) / "prefix", content)
        platform, licences = sysconfig.get_platform().replace("-", "_").replace(".", "_"), {}
        if settings.get("repair") == "yes":
            platform, licences = repair.bundle(content, "posewright")
        abi = f"cp{sys.version_info.major}{sys.version_info.minor}"
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        return wheel_file.write(content, pathlib.Path(wheel_directory), project, ROOT, f"{abi}-{abi}-{platform}", licences)


def build_sdist(sdist_directory, config_settings=None) -> str:
    raise SystemExit("posewright is built from its whole source folder; there is no source distribution")


def _install(built: str | None, prefix: pathlib.Path, content: pathlib.Path) -> None:
    """The package as CMake installs it, in `content`."""
    folder = pathlib.Path(built) if built else _build(ROOT / "build" / "wheel")
    if not (folder / "CMakeCache.txt").exists():
        raise SystemExit(f"{folder} is no build folder")
    _run("cmake", "--install", folder, "--component", "python", "--prefix", prefix, "--strip")
    found = list(prefix.rglob("posewright/__init__.py"))
    if not found:
        raise SystemExit(f"{folder} was configured without -DPOSEWRIGHT_BUILD_PYTHON=ON")
    content.mkdir()
    package = found[0].parent.rename(content / "posewright")
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    if not (package / f"_core{suffix}").exists():
        raise SystemExit(f"{folder} was built for {next(package.glob('_core*.so')).name}, not for {sys.executable} ({suffix})")


def _build(folder: pathlib.Path) -> pathlib.Path:
    _run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
         "-DPOSEWRIGHT_BUILD_TESTS=OFF", "-DPOSEWRIGHT_BUILD_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}")
    _run("cmake", "--build", folder, "--target", "posewright_python")
    return folder


def _run(*words) -> None:
    # What pip sets for its own modules is no business of CMake's helpers.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    subprocess.run([str(word) for word in words], check=True, env=environment)
