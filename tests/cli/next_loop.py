"""The loop of `next` as an instrument's program drives it: next_loop.py PROGRAM SOURCE.

A file of readings grows, in the middle of a line too; the process is interrupted and killed; files are replaced."""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
failures = []


def expect(what, good, seen=""):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)
        print(seen)


def run(*arguments, code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if code is not None and done.returncode != code:
        expect(f"exit status {code} of {' '.join(map(str, arguments))}", False, done.stdout + done.stderr)
    return done


class Watched:
    """`next --watch`; what it printed goes to a file."""

    def __init__(self, folder, *arguments):
        self.file = folder / f"said-{time.monotonic_ns()}.jsonl"
        self.process = subprocess.Popen([PROGRAM, "next", *map(str, arguments), "--watch", "--json", "--quiet"],
                                        stdout=open(self.file, "w"), stderr=subprocess.PIPE, text=True)

    def steps(self):
        return [json.loads(line) for line in self.file.read_text().splitlines() if line.endswith("}")]

    def wait_for(self, poses, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if any(step["measured"]["poses"] == poses for step in self.steps()):
                return True
            if self.process.poll() is not None:
                return any(step["measured"]["poses"] == poses for step in self.steps())
            time.sleep(0.05)
        return False


def append(file, text):
    with open(file, "a") as out:
        out.write(text)


with tempfile.TemporaryDirectory() as scratch:
    folder = pathlib.Path(scratch)
    for name in ("problem.yaml", "kr270.urdf"):
        shutil.copy(SOURCE / "examples" / "kr270" / name, folder)
    problem, data = folder / "problem.yaml", folder / "measured.csv"
    text = problem.read_text().replace("candidates: 5000", "candidates: 300")
    problem.write_text(text)
    run("plan", problem, "--poses", 14, "--method", "greedy", "--proof-time", 0, "-o", folder / "plan.json", "--poses-csv", folder / "p.csv")
    run("simulate", problem, folder / "plan.json", "--draws", 2, "--data", folder / "all.csv", code=None)
    header, *rows = (folder / "all.csv").read_text().splitlines(keepends=True)
    common = [problem, "--data", data]
    state = folder / "measured.next-state.json"

    first = json.loads(run("next", *common, "-k", 6, "--json").stdout)
    expect("a file that is not there yet gives the first poses", first["verdict"] == "not_determined" and len(first["poses"]) == 6)

    # Watching: half a line is no pose, and its end makes it one.
    data.write_text(header + "".join(rows[:7]) + rows[7][:40])
    watch = Watched(folder, *common, "-k", 2, "-o", folder / "next.csv", "--result", folder / "next.json")
    expect("whole lines are fitted, half a line is left", watch.wait_for(7))
    append(data, rows[7][40:70])
    time.sleep(0.7)
    expect("half a line that grows is still left", watch.steps()[-1]["measured"]["poses"] == 7)
    append(data, rows[7][70:] + rows[8])
    expect("a line that got its end is fitted", watch.wait_for(9))
    expect("the page's figures are those of the last step", json.loads((folder / "next.json").read_text())["measured"]["poses"] == 9)
    expect("the pose list is there and follows", (folder / "next.csv").read_text().splitlines()[1].startswith("10,"))
    for name, kind in (("Ctrl-C", signal.SIGINT), ("SIGTERM", signal.SIGTERM)):
        if name == "SIGTERM":
            watch = Watched(folder, *common)
            watch.wait_for(9)
        watch.process.send_signal(kind)
        code = watch.process.wait(10)
        expect(f"{name} ends a watch", code == 130, code)

    # Killed at any moment, the state is one that the next call takes.
    chance, grown = random.Random(4), 9
    for _ in range(6):
        watch = Watched(folder, *common, "-o", folder / "next.csv")
        time.sleep(chance.uniform(0.02, 0.5))
        watch.process.kill()
        watch.process.wait()
        json.loads(state.read_text())
    after = json.loads(run("next", *common, "-o", folder / "next.csv", "--json").stdout)
    expect("a killed process leaves a state and a pose list to go on with", after["measured"]["poses"] == grown)

    one_shot = run("next", *common)
    whole = data.read_text()
    append(data, rows[9][:30])
    cut = run("next", *common)
    expect("without --watch half a line is named", "measured.csv:11: has no line end yet" in cut.stderr, cut.stderr)
    expect("and counts for nothing", cut.stdout == one_shot.stdout)
    data.write_text(whole)

    # Files that are others.
    (folder / "mine.csv").write_text("my own list\n")
    refused = run("next", *common, "-o", folder / "mine.csv", code=1)
    expect("a file of somebody else is not overwritten", (folder / "mine.csv").read_text() == "my own list\n" and "--force" in refused.stderr)
    data.write_text(header + "".join(rows[1:]))
    refused = run("next", *common, code=2)
    expect("a replaced file is one line", "differs from the file" in refused.stderr and refused.stderr.count("\n") == 1, refused.stderr)
    data.write_text(header + rows[0])
    expect("a file that was cut is one line", "replaced or cut" in run("next", *common, code=2).stderr)
    data.write_text(whole)
    problem.write_text(text.replace("repeats: 3", "repeats: 2"))
    expect("another problem is one line", "was written before" in run("next", *common, code=2).stderr)
    restarted = run("next", *common, "--restart")
    expect("--restart begins anew", restarted.returncode == 0 and "9 poses measured" in restarted.stdout)
    problem.write_text(text)
    data.write_text(whole.replace("joint_a1", "axis_1"))
    another = run("next", *common, "--restart", code=2)
    expect("a file of another robot is named by its header", "measured.csv:1" in another.stderr, another.stderr)

    # Rows of another robot in a file that is right otherwise.
    other = rows[10].split(",")
    other[7] = str(float(other[7]) + 0.05)
    data.write_text(whole + rows[9] + ",".join(other))
    found = run("next", *common, "--restart", code=2)
    expect("a row of another robot is named by its line", "measured.csv:12: P1.x is" in found.stderr and "another robot" in found.stderr, found.stderr)

    # A watch ends by itself where the poses suffice.
    data.write_text(whole)
    watch = Watched(folder, *common, "--restart", "--required", "0.14mm")
    watch.wait_for(9)
    for row in rows[9:]:
        if watch.process.poll() is None:
            append(data, row)
            time.sleep(0.6)
    code = watch.process.wait(30)
    said = watch.steps()
    expect("a watch ends where the error is small enough with 95 % confidence", code == 0 and said[-1]["verdict"] == "reached", said[-1]["reason"])
    expect("and says before that it goes on", said[0]["verdict"] == "go_on")
    expect("the history has every step", [p["poses"] for p in said[-1]["history"]] == [s["measured"]["poses"] for s in said])
    for words in (["--required", "3"], ["--required", "-1 mm"], ["-k", 0], ["--watch"], ["--criterion", "best"]):
        expect(f"next {' '.join(map(str, words))} is refused in one line", run("next", problem, *words, code=2).stderr.count("\n") == 1)

sys.exit(f"failed: {', '.join(failures)}" if failures else 0)
