"""posewright with a criterion: `plan` where the part has a problem file, else `select` on the blocks."""
import json
import os
import pathlib
import subprocess
import sys

import _task

BLOCKS_ALONE = ("o1", "o2", "o3", "o4", "o5", "a")


def plan(criterion=None, variant=None):
    folder, poses, out = _task.arguments()
    if not os.environ.get("POSEWRIGHT"):
        _task.not_for_this("no program (--program)")
    problem, goal = (_task.task(folder)[key] for key in ("problem", "criterion"))
    if problem:
        if variant and f"  {variant}:" not in pathlib.Path(problem).read_text(encoding="utf-8"):
            _task.not_for_this(f"no variant {variant}")
        words = ["plan", problem, "--candidates-from", folder / "candidates.csv", "--poses-csv", "-"]
        words += ["--criterion", criterion] if criterion else []
        words += ["--variant", variant] if variant else []
    else:
        if variant or (criterion and criterion not in BLOCKS_ALONE):
            _task.not_for_this("needs a problem file")
        if criterion and goal and criterion != goal:
            _task.not_for_this(f"the set asks for {goal}")
        words = ["select", folder / "blocks.npy", "--criterion", goal or criterion or "o1"]
    words += ["--poses", str(poses), "--json", "-o", "-", "--quiet", "--threads", "1"]
    done = subprocess.run([os.environ["POSEWRIGHT"], *words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    found = json.loads(done.stdout)["poses"]
    _task.write(out, [int(p["listed"]["id"]) - 1 if problem else p["candidate"] for p in found])
