#!/usr/bin/env python3
"""How soon each command answers Ctrl-C, SIGTERM, SIGHUP and --time-limit, and with what.

    bench/interrupts.py build/release/bin/posewright examples/cell/problem.yaml
    bench/interrupts.py build/release/bin/posewright examples/cells/kuka_tracker.yaml --robots ROBOTS --moments 8

Each command runs once undisturbed, then once for each signal and moment, spread over its run, and for each time limit.
Printed: when the first line of progress came, seconds and processor seconds from signal (limit) to exit, the largest
first, and which stage took them. ROBOTS holds the folders that the cells name after ROBOTS/.
"""

import argparse
import json
import os
import pathlib
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
# What each command leaves, its words, and whether an early end may still have an answer to give (exit 0 at a limit).
COMMANDS = {
    "observe": ([], ["observe", "{problem}"]),
    "plan": (["new.json", "new.csv"], ["plan", "{problem}", "-o", "new.json", "--poses-csv", "new.csv"]),
    "route": (["new.json"], ["route", "plan.json", "--closed", "--from-home", "-o", "new.json"]),
    "report": (["new.html"], ["report", "plan.json", "-o", "new.html"]),
    "stations": ([], ["stations", "{problem}", "--json"]),
    "evaluate": ([], ["evaluate", "{problem}", "plan.json", "--drop", "2", "--add", "2", "--json"]),
    "compare": ([], ["compare", "{problem}", "--json"]),
    "simulate": ([], ["simulate", "{problem}", "plan.json", "--json"]),
    "calibrate": (["new.yaml"], ["calibrate", "{problem}", "measured.csv", "-o", "new.yaml"]),
    "next": (["new.csv"], ["next", "{problem}", "--data", "measured.csv", "--state", "-", "-o", "new.csv"]),
}
LIMITED = ["plan", "route", "report", "stations", "evaluate"]


class Run:
    """A command that runs: what it tells and when, and what becomes of it."""

    def __init__(self, words, folder):
        self.begin = time.monotonic()
        self.process = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.lines, self.out = [], queue.Queue()
        self.readers = [threading.Thread(target=self.read_lines), threading.Thread(target=self.read_out)]
        for reader in self.readers:
            reader.start()

    def read_lines(self):
        for line in self.process.stderr:
            self.lines.append((time.monotonic() - self.begin, line.rstrip("\n")))

    def read_out(self):
        self.out.put(self.process.stdout.read())

    def processor(self):
        try:
            fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        except (FileNotFoundError, ProcessLookupError):
            return 0.0
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def wait_until(self, moment):
        """Whether it still runs then."""
        try:
            self.process.wait(max(0.0, self.begin + moment - time.monotonic()))
            return False
        except subprocess.TimeoutExpired:
            return True

    def end(self):
        """Exit code, seconds since the start, processor seconds; everything is read."""
        _, status, usage = os.wait4(self.process.pid, 0) if self.process.returncode is None else (0, None, None)
        seconds = time.monotonic() - self.begin
        if status is not None:
            self.process.returncode = os.waitstatus_to_exitcode(status)
        for reader in self.readers:
            reader.join()
        self.text = self.out.get()
        return self.process.returncode, seconds, usage.ru_utime + usage.ru_stime if usage else 0.0

    def stage(self, moment):
        told = [line for at, line in self.lines if at <= moment and not line.startswith("posewright:")]
        return told[-1] if told else "(before the first line)"


class Bench:
    def __init__(self, options):
        self.options = options
        self.program = str(options.program.resolve())
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="interrupts-"))
        self.packages = []
        self.problem = options.problem.resolve()
        if options.robots:
            robots = options.robots.resolve()
            for mesh in self.problem.parent.glob("*.stl"):
                (self.folder / mesh.name).write_bytes(mesh.read_bytes())
            copy = self.folder / self.problem.name
            copy.write_text(self.problem.read_text().replace("ROBOTS", str(robots)))
            self.problem = copy
            self.packages = [f"--package={p.name}={p}" for p in robots.glob("*/*") if p.is_dir()]
        self.failures = []

    def words(self, command, *more):
        words = [word.replace("{problem}", str(self.problem)) for word in COMMANDS[command][1]]
        return [self.program, *words, *self.packages, *self.options.more, "--verbose", *more]

    def prepare(self):
        for words in (["plan", self.problem, "-o", "plan.json", "--poses-csv", "-", *self.options.more],
                      ["simulate", self.problem, "plan.json", "--draws", "2", "--data", "measured.csv"]):
            done = subprocess.run([self.program, *map(str, words), *self.packages, "--quiet"], cwd=self.folder,
                                  capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(done.stderr)

    def clear(self, command):
        for name in COMMANDS[command][0]:
            (self.folder / name).unlink(missing_ok=True)

    def left(self, command, run):
        """What an ended run has: files, an answer, whether it says that it was ended early."""
        words = [name for name in COMMANDS[command][0] if (self.folder / name).exists()]
        if run.text.strip():
            words.append("answer")
        told = "\n".join(line for _, line in run.lines if line.startswith("posewright:"))
        plan = self.folder / "new.json"
        if command == "plan" and plan.exists():
            words.append("interrupted: " + json.dumps(json.loads(plan.read_text())["interrupted"]))
        return ", ".join(words) or "nothing", told

    def one(self, command, moment, how, *more):
        """Ends a run at a moment; None if it was done before."""
        self.clear(command)
        run = Run(self.words(command, *more), self.folder)
        if not run.wait_until(moment):
            run.end()
            return None
        asked, before = time.monotonic() - run.begin, run.processor()
        if how is not None:
            run.process.send_signal(how)
        code, seconds, processor = run.end()
        left, told = self.left(command, run)
        return {"command": command, "how": how.name if how else "time limit", "moment": round(asked, 2), "code": code,
                "answer": round(seconds - asked, 3), "processor": round(processor - before, 3),
                "stage": run.stage(asked), "left": left, "told": told, "first": run.lines[0][0] if run.lines else None}

    def measure(self, command):
        self.clear(command)
        run = Run(self.words(command), self.folder)
        code, whole, processor = run.end()
        first = run.lines[0][0] if run.lines else None
        if code != 0:
            self.failures.append(f"{command} undisturbed: exit {code}: {run.lines[-1][1] if run.lines else ''}")
        print(f"{command:10} {whole:6.1f} s, {processor:6.1f} s of processor; first line of progress after "
              + ("-" if first is None else f"{first:.2f} s"), flush=True)
        if first is None or first > 1 and whole > 1:
            self.failures.append(f"{command}: nothing told within the first second of {whole:.1f}")
        rows = []
        moments = self.options.moments
        for s, how in enumerate(SIGNALS):
            for k in range(moments):
                # Between the first second, in which libraries are loaded, and the end.
                share = (k + (s + 0.5) / len(SIGNALS)) / moments
                rows.append(self.one(command, 0.3 + share * max(0.0, whole - 0.4), how))
        if command in LIMITED:
            for k in range(moments):
                limit = max(0.2, (k + 0.5) / moments * whole)
                rows.append(self.one(command, limit, None, "--time-limit", f"{limit:.3f}"))
        rows = [row for row in rows if row]
        for row in rows:
            if row["answer"] > self.options.within:
                self.failures.append(f"{command}: {row['how']} at {row['moment']} s answered after {row['answer']} s")
            if row["code"] not in ((0, 130) if row["how"] != "time limit" else (0, 1)):
                self.failures.append(f"{command}: {row['how']} at {row['moment']} s: exit {row['code']}")
        for row in sorted(rows, key=lambda r: -r["answer"])[:self.options.show]:
            print("    {how:10} at {moment:6.2f} s: {answer:6.3f} s ({processor:.2f} of processor), exit {code}, left: "
                  "{left}; {stage}; {told}".format(**row), flush=True)
        return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("problem", type=pathlib.Path)
    parser.add_argument("--robots", type=pathlib.Path)
    parser.add_argument("--commands", default=",".join(COMMANDS))
    parser.add_argument("--moments", type=int, default=4, help="for each signal, and time limits")
    parser.add_argument("--within", type=float, default=1.0, help="s; a later answer is a failure")
    parser.add_argument("--show", type=int, default=1000, help="rows printed for each command, the latest answers first")
    parser.add_argument("--more", nargs="*", default=[], help="for every command")
    bench = Bench(parser.parse_args())
    bench.prepare()
    for command in bench.options.commands.split(","):
        bench.measure(command)
    for failure in bench.failures:
        print(failure, file=sys.stderr)
    sys.exit(1 if bench.failures else 0)


if __name__ == "__main__":
    main()
