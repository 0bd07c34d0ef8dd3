"""What installs without compiling, each in an empty place: `pip install .`, the wheels of program and Python package, the archive:
use_wheel.py SOURCE BUILD SCRATCH.

No index is reached, so numpy, the one dependency, is Debian's, linked into the environments. The second roads: the loader's own list
of what it would load, and the running process's own map of files."""
import hashlib
import json
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile

from debian import need, run, skip

need(cmake="cmake", patchelf="patchelf", ldd="libc-bin")
for module in ("pip", "venv", "numpy"):
    if subprocess.run(["/usr/bin/python3", "-c", f"import {module}"], capture_output=True).returncode != 0:
        skip(f"{module} is missing (Debian: python3-{module})")
source, build, scratch = map(pathlib.Path, sys.argv[1:])
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
VERSION = re.search(r"project\(posewright VERSION (\S+)", (source / "CMakeLists.txt").read_text()).group(1)
EXAMPLE = source / "examples/kr270/problem.yaml"
SCRIPT = """
import json, sys
import posewright as pw
maps = {line.split()[5] for line in open("/proc/self/maps") if ".so" in line}
plan = pw.plan(pw.Problem(sys.argv[1]), candidates=60, method="greedy")
print(json.dumps([pw.__file__, pw.__version__, len(plan), plan.log_det, sorted(maps)]))
"""
BROUGHT = ("ompl", "fcl", "assimp", "yaml-cpp", "nlopt")


def environment(name):
    """An environment that has numpy and nothing else."""
    folder = scratch / name
    run("/usr/bin/python3", "-m", "venv", "--without-pip", folder)
    [site] = folder.glob("lib/python3*/site-packages")
    assert not list(site.iterdir())
    (site / "numpy").symlink_to("/usr/lib/python3/dist-packages/numpy")
    return folder / "bin/python", site


def pip(python, *words):
    return run("/usr/bin/python3", "-m", "pip", "--python", python, *words)


def install(python, *what):
    pip(python, "install", "--disable-pip-version-check", "--no-index", "--no-deps", *what)


def use(python, site):
    """The plan's log det, and which libraries the process has loaded."""
    file, version, poses, log_det, maps = json.loads(run(python, "-I", "-c", SCRIPT, EXAMPLE, cwd=scratch))
    assert file == str(site / "posewright/__init__.py") and version == VERSION and poses == 18, (file, version, poses)
    run(python, "-I", "-c", "import posewright, posewright._mapping", cwd=scratch)
    return log_det, maps


def from_debian(maps):
    """Loaded libraries of Debian's packages that a plain system and numpy do not bring."""
    return {name for name in maps if name.startswith(("/usr/lib", "/lib")) and any(part in name for part in BROUGHT)}


def plan_of(program, name):
    """Bytes of a small plan's poses."""
    folder = scratch / name
    folder.mkdir()
    said = run(program, "plan", EXAMPLE, "--candidates", "60", "--method", "greedy", cwd=folder)
    assert "18 poses for variant" in said, said
    return (folder / "poses.csv").read_bytes()


def refused(program, **tools):
    """What the launcher says where programs that it asks give other answers."""
    folder = scratch / "asked"
    folder.mkdir()
    for name, answer in tools.items():
        (folder / name).write_text(f"#!/bin/sh\n{answer}\n")
        (folder / name).chmod(0o755)
    done = subprocess.run([program, "--version"], capture_output=True, text=True, env={"PATH": f"{folder}:/usr/bin:/bin"})
    shutil.rmtree(folder)
    assert done.returncode == 1 and not done.stdout and done.stderr.count("\n") == 1, done
    return done.stderr


# pip install . of the source folder; the build folder of these tests spares a second compilation.
python, site = environment("plain")
install(python, "--config-settings", f"built={build}", source)
plain, maps = use(python, site)
assert len(from_debian(maps)) == 5, maps
pip(python, "uninstall", "--yes", "posewright-python")
assert [path.name for path in site.iterdir()] == ["numpy"]

wheels = subprocess.run([source / "scripts/wheel", scratch / "made", build], capture_output=True, text=True)
if platform.freedesktop_os_release()["VERSION_CODENAME"] != "bookworm":
    # A younger system's libraries would shut out older ones.
    assert wheels.returncode == 1 and wheels.stderr.endswith("build on Debian 12, so that older systems can run it\n"), wheels
    assert not list((scratch / "made").iterdir())
    skip("wheels are made on Debian 12, as scripts/wheel says here (pip install . works)")
assert wheels.returncode == 0, wheels.stdout + wheels.stderr
[program_wheel] = (scratch / "made").glob(f"posewright-{VERSION}-py3-none-manylinux_2_*.whl")
[python_wheel] = (scratch / "made").glob(f"posewright_python-{VERSION}-cp3*-manylinux_2_*.whl")
[archive] = (scratch / "made").glob(f"posewright-{VERSION}-linux-*.tar.gz")

# The program, with libraries of its own alone.
python, site = environment("wheels")
install(python, program_wheel)
program = python.parent / "posewright"
assert run(program, "--version").startswith(f"posewright {VERSION}")
by_build = plan_of(build / "bin/posewright", "by-build")
assert plan_of(program, "by-wheel") == by_build
tree = site / "posewright_program"
listed = run("env", "LD_TRACE_LOADED_OBJECTS=1", tree / "libexec/posewright")
loaded = dict(re.findall(r"^\s*(\S+) => (\S+)", listed, re.M))
everywhere = re.compile(r"lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s)\.so\.\d+")
ours = {pathlib.Path(path).resolve() for name, path in loaded.items() if not everywhere.fullmatch(name)}
assert ours == {path.resolve() for path in (tree / "lib").iterdir()} and len(ours) > 10, listed
assert len(list(tree.glob("share/posewright/*/*"))) > 10
names = zipfile.ZipFile(program_wheel).namelist()
licences = [name for name in names if ".dist-info/licenses/" in name]
assert any("libompl" in name for name in licences) and any("libnlopt" in name for name in licences)

# The Python package on the program's libraries.
install(python, python_wheel)
on_program, maps = use(python, site)
assert on_program == plain, (on_program, plain)
assert not from_debian(maps), from_debian(maps)
used = {pathlib.Path(name) for name in maps if name.startswith(str(tree / "lib"))}
# All that the program brings, but what reads its command line.
unused = set((tree / "lib").iterdir()) - used
assert len(used) > 10 and [path.name.partition("-")[0] for path in unused] == ["libboost_program_options"], (unused, maps)
about = zipfile.ZipFile(python_wheel).read(f"posewright_python-{VERSION}.dist-info/METADATA").decode()
assert f"Requires-Dist: posewright == {VERSION}\n" in about and "Requires-Dist: numpy\n" in about, about
pip(python, "uninstall", "--yes", "posewright", "posewright-python")
assert [path.name for path in site.iterdir()] == ["numpy"] and not program.exists()

# The archive is the same tree; the program is found through links, too.
with tarfile.open(archive) as packed:
    packed.extractall(scratch)
unpacked = scratch / archive.name.removesuffix(".tar.gz")
in_wheel = {name.removeprefix("posewright_program/"): hashlib.sha256(zipfile.ZipFile(program_wheel).read(name)).digest()
            for name in names if name.startswith("posewright_program/")}
del in_wheel["__init__.py"]
in_archive = {str(path.relative_to(unpacked)): hashlib.sha256(path.read_bytes()).digest() for path in unpacked.rglob("*") if path.is_file()}
assert in_wheel.items() <= in_archive.items() and {name.split("/")[0] for name in set(in_archive) - set(in_wheel)} == {"LICENSE", "licenses"}
(scratch / "linked").symlink_to(unpacked / "bin/posewright")
assert plan_of(scratch / "linked", "by-archive") == by_build

# Systems that it cannot run on get one line.
glibc = re.search(r"manylinux_(\d+)_(\d+)_", program_wheel.name)
launcher = unpacked / "bin/posewright"
assert f"needs glibc {glibc[1]}.{glibc[2]} or later" in refused(launcher, getconf="echo glibc 2.31")
assert refused(launcher, getconf="echo glibc 2.31").endswith("this system has glibc 2.31\n")
assert "another C library" in refused(launcher, getconf="exit 1")
assert "this machine is aarch64" in refused(launcher, uname="echo aarch64")

# Wrong settings are named, and nothing is written.
for settings, said in ((["built=/nowhere"], "/nowhere is no build folder"), (["speed=9"], "unknown settings")):
    words = [word for setting in settings for word in ("--config-settings", setting)]
    done = subprocess.run(["/usr/bin/python3", "-m", "pip", "wheel", "--no-deps", "--no-index", "-w", scratch / "none", *words, source], capture_output=True, text=True)
    assert done.returncode != 0 and said in done.stderr + done.stdout, done.stderr
assert not list((scratch / "none").glob("*"))
shutil.rmtree(scratch)
