"""Commands that write for robots, with every write, rename, fsync and allocation failing once, and killed: calls_fail_once.py PROGRAM LIBRARY [MOST].

One call of a run fails, for each call of the kind or for MOST of them, evenly spread. Then the command ends with an error of one line and all
files are as before, or the failure did no harm: status 0 and the files of a run without one. No other file is left. After a kill every file
that is there is whole.
"""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM, LIBRARY = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
MOST = int(sys.argv[3]) if len(sys.argv) > 3 else 5
KINDS = ("write", "rename", "fsync", "mkostemp", "malloc")

BALL = '<collision><geometry><sphere radius="0.05"/></geometry></collision>'
ARM = "".join(
    f'<joint name="j{k + 1}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/><origin xyz="{x} 0 {z}"/><axis xyz="{axis}"/>'
    f'<limit lower="{-limit}" upper="{limit}" velocity="2" effort="1"/></joint><link name="l{k + 1}">{BALL if k == 5 else ""}</link>'
    for k, (x, z, axis, limit) in enumerate([(0, 0, "0 0 1", 2.9), (0.1, 0.4, "0 1 0", 1.7), (0, 0.5, "0 1 0", 1.7), (0.4, 0.1, "1 0 0", 2.9),
                                             (0.2, 0, "0 1 0", 2.0), (0, 0, "1 0 0", 2.9)]))
ARM = f'<robot name="arm"><link name="l0"/>{ARM}</robot>\n'
PROBLEM = """posewright: 1
robot: {urdf: arm.urdf, base: l0, tip: l6}
measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
variants: {geometric: {parameters: ["j2.x", "j2.offset", "j3.offset"]}}
design: {poses: 6, candidates: 60, restarts: 1}
"""
KRL = """DEF W()
PTP {A1 10,A2 -20,A3 30,A4 0,A5 40,A6 5}
LIN {X 700,Y 50,Z 500,A 0,B 60,C 0,S 2,T 8}
PTP XP1
END
"""


def run(folder, words, **environment):
    path = f"{folder}/bin:{os.environ['PATH']}"
    return subprocess.run([PROGRAM, *words, "--threads", "1"], cwd=folder, capture_output=True, text=True, timeout=300,
                          env={**os.environ, "PATH": path, "TMPDIR": str(folder), **environment})


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def make(folder):
    (folder / "bin").mkdir()
    xacro = folder / "bin" / "xacro"
    xacro.write_text("#!/bin/sh\ncat \"$1\"\n")
    xacro.chmod(0o755)
    (folder / "arm.urdf").write_text(ARM)
    (folder / "arm.urdf.xacro").write_text(ARM.replace("<robot ", '<robot xmlns:xacro="http://ros.org/wiki/xacro" ', 1))
    (folder / "problem.yaml").write_text(PROBLEM)
    digest = hashlib.sha256(PROBLEM.encode()).hexdigest()
    (folder / "cal.yaml").write_text("posewright_parameters: 1\nvariant: geometric\nproblem: {file: problem.yaml, sha256: " + digest +
                                     "}\nparameters: {j2.offset: {value: 0.002, unit: rad, nominal: 0}}\n")
    (folder / "w.src").write_text(KRL)
    (folder / "w.dat").write_text("DEFDAT W\nDECL E6AXIS XP1={A1 0,A2 10,A3 20,A4 0,A5 30,A6 0}\nENDDAT\n")
    for words in (["plan", "problem.yaml", "--proof-time", "0"], ["route", "plan.json", "--from-home", "-o", "r.json"]):
        done = run(folder, words)
        assert done.returncode == 0, done.stderr
    # A ball stands where the tip of a pose is.
    place = json.loads((folder / "plan.json").read_text())["poses"][2]["tool_pose"]["position"]
    (folder / "blocked.yaml").write_text(f"{PROBLEM}workspace: {{collision: {{self: false, obstacles: [{{name: ball, sphere: 0.1, at: {place}}}]}}}}\n")


COMMANDS = (
    ["compensate", "cal.yaml", "w.src", "w.dat", "-o", "out/", "--tool", "0 0 0 0 0 0", "--base", "0 0 0 0 0 0"],
    ["route", "plan.json", "--problem", "blocked.yaml", "--from-home", "--replace", "-o", "replaced.json", "--seed", "3"],
    ["init", "arm.urdf.xacro", "--tracker", "--yes", "-o", "made.yaml"],
    ["export", "r.json", "--to", "kuka-krl", "-o", "out/"],
    ["export", "r.json", "--to", "staubli-val3", "-o", "out/"],
    ["export", "r.json", "--to", "fanuc-tp", "--coupling", "0", "-o", "p.ls"],
)


def steady(files):
    """Without what two runs of the same command differ in."""
    return {name: b"\n".join(line for line in text.split(b"\n") if b'"seconds"' not in line) if name == "replaced.json" else text for name, text in files.items()}


def restore(folder, old):
    for name in contents(folder).keys() - old.keys():
        (folder / name).unlink()
    for path in folder.iterdir():
        if path.is_dir() and path.name != "bin":
            shutil.rmtree(path)


def check_kills(folder, words, old, new, seconds):
    """Most of them near the end, where files are written."""
    for k in range(MOST):
        process = subprocess.Popen([PROGRAM, *words, "--threads", "1"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env={**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}"})
        try:
            process.wait(seconds * (1 - 0.3 * (k / MOST) ** 2))
        except subprocess.TimeoutExpired:
            process.kill()
        process.wait()
        now = contents(folder)
        assert all(now[name] == old[name] for name in old), words
        whole, found = steady(new), steady(now)
        assert all(found[name] == whole[name] for name in new if name in found), words
        restore(folder, old)
    print(f"  {MOST} kills", flush=True)


def check(folder, words, old):
    """Runs with one failure each; the number of them. After each all is as it was."""
    begin = time.monotonic()
    done = run(folder, words)
    assert done.returncode == 0, (words, done.stderr)
    seconds = time.monotonic() - begin
    new = contents(folder)
    restore(folder, old)
    assert new.keys() - old.keys(), words
    check_kills(folder, words, old, new, seconds)
    failed = 0
    for kind in KINDS:
        counted = run(folder, words, LD_PRELOAD=str(LIBRARY), FAIL_CALL=kind, COUNT_FILE=str(folder / "count"))
        count = int((folder / "count").read_text())
        assert counted.returncode == 0, counted.stderr
        restore(folder, old)
        places = range(1, count + 1) if count <= MOST else sorted({1 + round(k * (count - 1) / (MOST - 1)) for k in range(MOST)})
        # The number of allocations differs by some: one that comes when the files are written, for the summary.
        if kind == "malloc": places = sorted({*places, count - 10})
        for at in places:
            done = run(folder, words, LD_PRELOAD=str(LIBRARY), FAIL_CALL=kind, FAIL_AT=str(at))
            now = contents(folder)
            where = f"{words[0]}: {kind} {at} of {count}: status {done.returncode}: {done.stderr[:400]}"
            if done.returncode == 0:
                assert steady(now) == steady(new), where + f" {sorted(now.keys() ^ new.keys())}"
            else:
                assert done.returncode in (1, 2, 3), where
                assert sum(line.startswith("posewright: ") and not line.startswith("posewright: note") for line in done.stderr.splitlines()) == 1, where
                saved = done.stderr.split("saved as ")[-1].split(", ") if "saved as " in done.stderr else []
                left = [name for name in now.keys() - old.keys() if not any(word.strip().endswith(name) for word in saved)]
                assert not left or all(now[name] == new.get(name) for name in left), where + f" left: {left}"
                # Files that are all there, as of a run without a failure, are named in the error.
                assert not left or len(left) < len(new.keys() - old.keys()), where
                assert all(now[name] == old[name] for name in old), where
            failed += 1
            restore(folder, old)
        print(f"  {kind}: {len(places)} of {count}", flush=True)
    return failed


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make(folder)
        old = contents(folder)
        for words in COMMANDS:
            print(" ".join(words[:4]), flush=True)
            print(f"  {check(folder, words, old)} failures: an error of one line with nothing half written, or no harm", flush=True)


main()
