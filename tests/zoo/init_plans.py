"""`init` plans on robots like those of public URDF files: init_plans.py PROGRAM [all | KIND…].

Each kind of robots.py is made; `init` writes its problem at the first call and `plan` plans it, or one line names what to change. Without words a sample is taken, in seconds.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

import robots

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
QUICK = ("--candidates", "40", "--restarts", "1", "--proof-time", "0")
SAMPLE = ("axes_1", "gripper_with_mimic", "camera_link_in_the_floor", "scara", "hangs_from_its_foot", "mobile_base_that_floats", "meshes_in_mm_without_scale", "names_in_other_alphabets", "two_arms_without_a_choice", "limits_upside_down")


def run(folder, *words):
    return subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True, timeout=600)


def messages(text):
    return [line for line in text.splitlines() if line.startswith("posewright: ")]


def fault_of(kind, folder):
    """What is wrong with what `init` and `plan` do; None: nothing."""
    words = kind.words if "--camera" in kind.words else ("--tracker", *kind.words)
    init = run(folder, "init", kind.file, "--yes", *words)
    if kind.refusal:
        missing = [word for word in kind.refusal if word not in init.stderr]
        left = sorted(set(os.listdir(folder)) & {"problem.yaml"})
        return None if init.returncode and not missing and not left and len(messages(init.stderr)) == 1 else f"{init.returncode}, {missing}, {left}: {init.stderr}"
    if init.returncode:
        return "init: " + init.stderr
    if (kind.note not in init.stderr) if kind.note else init.stderr:
        return f"notes '{init.stderr}' where '{kind.note}' is due"
    if kind.says not in (pathlib.Path(folder) / "problem.yaml").read_text():
        return f"'{kind.says}' is not in the file"
    plan = run(folder, "plan", "problem.yaml", *QUICK)
    return "plan: " + plan.stderr if plan.returncode else None


def main(names):
    faults = planned = 0
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            begin = time.monotonic()
            kind = robots.KINDS[name](folder)
            fault = fault_of(kind, folder)
            faults += fault is not None
            planned += fault is None and not kind.refusal
            print(f"{name:36} {time.monotonic() - begin:5.1f} s  {fault or ('refused as it should be' if kind.refusal else 'plans')}", flush=True)
    print(f"{planned} of {len(names)} kinds are planned at the first call, {len(names) - planned - faults} refused with a line that names the cause, {faults} faults")
    return faults > 0


if __name__ == "__main__":
    chosen = sys.argv[2:] or SAMPLE
    sys.exit(main(list(robots.KINDS) if list(chosen) == ["all"] else chosen))
