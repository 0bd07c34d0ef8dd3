"""`pip install .` and the wheel that brings its libraries, each in an empty Python environment: use_wheel.py SOURCE BUILD SCRATCH.

No index is reached, so numpy, the one dependency, is Debian's, linked into the environment. The second road: the running
process's own map of files says which libraries it has loaded."""
import json
import pathlib
import shutil
import subprocess
import sys
import zipfile

from debian import need, run, skip

need(cmake="cmake", patchelf="patchelf", ldd="libc-bin")
for module in ("pip", "venv", "numpy"):
    if subprocess.run(["/usr/bin/python3", "-c", f"import {module}"], capture_output=True).returncode != 0:
        skip(f"{module} is missing (Debian: python3-{module})")
source, build, scratch = map(pathlib.Path, sys.argv[1:])
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
EXAMPLE = source / "examples/kr270/problem.yaml"
SCRIPT = """
import json, sys
import posewright as pw
maps = {line.split()[5] for line in open("/proc/self/maps") if ".so" in line}
plan = pw.plan(pw.Problem(sys.argv[1]), candidates=60, method="greedy")
import importlib.metadata as metadata
print(json.dumps([pw.__file__, metadata.version("posewright"), len(plan), plan.log_det, sorted(maps)]))
"""


def environment(name):
    """An environment that has numpy and nothing else."""
    folder = scratch / name
    run("/usr/bin/python3", "-m", "venv", "--without-pip", folder)
    [site] = folder.glob("lib/python3*/site-packages")
    assert not list(site.iterdir())
    (site / "numpy").symlink_to("/usr/lib/python3/dist-packages/numpy")
    return folder / "bin/python", site


def install(python, *what):
    run("/usr/bin/python3", "-m", "pip", "--python", python, "install", "--disable-pip-version-check", "--no-index", "--no-deps", *what)


def use(python, site):
    """What the package says where it is installed; [plan's poses, log det, libraries loaded by the process]."""
    file, version, poses, log_det, maps = json.loads(run(python, "-I", "-c", SCRIPT, EXAMPLE, cwd=scratch))
    assert file == str(site / "posewright/__init__.py") and version == "0.1.0" and poses == 18, (file, version, poses)
    run(python, "-I", "-c", "import posewright, posewright._mapping", cwd=scratch)
    return log_det, maps


def from_debian(maps):
    """Loaded libraries of Debian's packages that a plain system and numpy do not bring."""
    return {name for name in maps if name.startswith(("/usr/lib", "/lib")) and any(part in name for part in ("ompl", "fcl", "assimp", "yaml-cpp", "nlopt"))}


# pip install . of the source folder; the build folder of these tests spares a second compilation.
python, site = environment("plain")
install(python, "--config-settings", f"built={build}", source)
plain, maps = use(python, site)
assert len(from_debian(maps)) == 5, maps
run("/usr/bin/python3", "-m", "pip", "--python", python, "uninstall", "--yes", "posewright")
assert [path.name for path in site.iterdir()] == ["numpy"]

# The repaired wheel.
run(source / "scripts/wheel", scratch / "wheels", build)
[wheel] = (scratch / "wheels").glob("posewright-0.1.0-cp3*-manylinux_2_*.whl")
python, site = environment("repaired")
install(python, wheel)
repaired, maps = use(python, site)
assert repaired == plain, (repaired, plain)
assert not from_debian(maps), from_debian(maps)
ours = {pathlib.Path(name).name for name in maps if name.startswith(str(site / "posewright.libs"))}
names = zipfile.ZipFile(wheel).namelist()
assert ours == {name.split("/")[1] for name in names if name.startswith("posewright.libs/")} and len(ours) > 10, ours
licences = [name for name in names if ".dist-info/licenses/" in name]
assert any("libompl" in name for name in licences) and any("libnlopt" in name for name in licences)

# Wrong settings are named, and nothing is written.
for settings, said in ((["built=/nowhere"], "/nowhere is no build folder"), (["repair=perhaps"], "yes and no are allowed"), (["speed=9"], "unknown settings")):
    words = [word for setting in settings for word in ("--config-settings", setting)]
    done = subprocess.run(["/usr/bin/python3", "-m", "pip", "wheel", "--no-deps", "--no-index", "-w", scratch / "none", *words, source], capture_output=True, text=True)
    assert done.returncode != 0 and said in done.stderr + done.stdout, done.stderr
assert not list((scratch / "none").glob("*"))
shutil.rmtree(scratch)
