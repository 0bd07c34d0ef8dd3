"""The package of npm in an empty folder, from a URDF to a program of the robot and a calibrated file: use_npm.py SOURCE PACKAGE
[PROGRAM].

PACKAGE is the archive, or a folder that holds it. The second road is the native PROGRAM on the same files: its figures and the
robot's program are the same; of one with musl's functions plans are, to the last digit."""
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from debian import need, run, skip

need(node="nodejs", npm="npm")
source, package = map(pathlib.Path, sys.argv[1:3])
native = sys.argv[3] if len(sys.argv) > 3 else None
version = re.search(r"project\(posewright VERSION (\S+)", (source / "CMakeLists.txt").read_text()).group(1)
if package.is_dir() or not package.exists():
    package /= f"posewright-{version}.tgz"
if not package.exists():
    skip(f"there is no {package.name} (scripts/wasm build/wasm-package makes it)")

STEPS = (("init", "kr270.urdf", "--tracker"),
         ("plan", "problem.yaml", "--candidates", "60", "--poses", "10"),
         ("route", "plan.json", "--from-home", "--closed"),
         ("export", "route.json", "--to", "kuka-krl", "-o", "CALPOSES.src"),
         ("simulate", "problem.yaml", "plan.json", "--draws", "2", "--data", "measured.csv"),
         ("calibrate", "problem.yaml", "measured.csv", "-o", "calibrated.yaml"))
TIMES = re.compile(r"\b\d+\.\d+ s\b")


def flow(folder, *program):
    shutil.copy(source / "examples/kr270/kr270.urdf", folder)
    return [TIMES.sub("", run(*program, *step, cwd=folder)) for step in STEPS]


def alike(one, other):
    """The same words, and numbers within 0.1 %."""
    one, other = one.split(), other.split()
    return len(one) == len(other) and all(a == b or near(a, b) for a, b in zip(one, other))


def near(a, b):
    try:
        return math.isclose(float(a.strip("(),:;")), float(b.strip("(),:;")), rel_tol=1e-3)
    except ValueError:
        return False


def memory_that_ends(folder):
    """One sentence and nothing half written where memory ends: in a search, beyond 32 bits, before the program begins."""
    script = folder / "node_modules/posewright/posewright.mjs"
    before = sorted(folder.iterdir())
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (67200000, 1, 1), }".ljust(117) + b"\n"
    with open(folder / "wide.npy", "wb") as file:  # 268 MB that take no place on the disk; its blocks need 4.3 GB, 6 MB modulo 2^32
        file.write(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
        file.truncate(10 + len(header) + 4 * 67200000)
    plan = ("plan", "problem.yaml", "--candidates", "60000", "--proof-time", "0", "-o", "lost.json", "--poses-csv", "lost.csv")
    in_words = "not enough memory; ask for fewer candidates"
    for flags, words, sentence in (
            (("--wasm-max-mem-pages=1500",), plan, in_words), ((), ("select", "wide.npy", "--poses", "5", "-o", "lost.json"), in_words),
            (("--wasm-max-mem-pages=100",), plan, "not enough memory (WebAssembly has 4 GB at most); ask for fewer candidates")):
        done = subprocess.run(["node", *flags, script, *words], cwd=folder, capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (1, "") and "    at " not in done.stderr, (words, done)
        assert done.stderr.splitlines()[-1] == f"posewright: {sentence}", (words, done)
    (folder / "wide.npy").unlink()
    assert sorted(folder.iterdir()) == before


def poses(folder, name):
    return json.loads((folder / name).read_text())["poses"]


def same_plans(here, there, npx, native):
    """With the same sin and cos to the last digit: a pose, and a pair of poses, whose search has twelve coordinates."""
    assert poses(here, "plan.json") == poses(there, "plan.json")
    pairs = (source / "examples/instruments/ball_bar.yaml").resolve()
    small = ("--candidates", "60", "--poses", "24", "--restarts", "1", "--method", "continuous", "-o", "pairs.json")
    for folder, program in ((here, npx), (there, native)):
        run(*program, "plan", pairs, *small, cwd=folder)
    assert poses(here, "pairs.json") == poses(there, "pairs.json")


with tempfile.TemporaryDirectory() as empty, tempfile.TemporaryDirectory() as other:
    here, there = pathlib.Path(empty), pathlib.Path(other)
    run("npm", "install", "--offline", "--no-audit", "--no-fund", package.resolve(), cwd=here)
    npx = ("npx", "--offline", "posewright")
    assert run(*npx, "--version", cwd=here) == f"posewright {version}\nMathematical functions: musl\n"
    licences = (here / "node_modules/posewright/LICENSES.txt").read_text()
    assert all(f"==== {name}" in licences for name in ("nlopt/src/algs/luksan", "ompl", "libeigen3-dev", "emscripten", "report/dist"))
    said = flow(here, *npx)
    assert "PTP" in (here / "CALPOSES.src").read_text()
    assert (here / "calibrated.yaml").read_text().startswith("posewright_parameters: 1\n")
    assert len(json.loads((here / "plan.json").read_text())["poses"]) == 10
    memory_that_ends(here)
    if native:
        for step, mine, theirs in list(zip(STEPS, said, flow(there, native)))[:4]:
            assert alike(mine, theirs), f"{step[0]}: node\n{mine}\nnative\n{theirs}"
        for name in ("CALPOSES.src", "CALPOSES.dat"):
            assert alike((here / name).read_text(), (there / name).read_text()), name
        if "functions: musl" in run(native, "--version", cwd=there):
            same_plans(here, there, npx, (native,))
