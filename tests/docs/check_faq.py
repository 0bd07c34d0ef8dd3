"""Every figure of docs/faq.md is computed again: check_faq.py SOURCE PROGRAM.

ANSWERS says of each sentence with a figure how the program gives it. A number that is in none of these sentences, nor in
DEFINITIONS, is an error; so is a figure that could be changed without one, which is tried with each."""
import functools
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import figures

SMALL = "--candidates 1000 --method exchange --restarts 2"

# Numbers that say what is meant, and are no result.
DEFINITIONS = [
    "seed 0, from", "(18 poses of 1,000 candidates,", "KR 270", "1/√N", "to 1e-4 of its effect",
    "2σ to 3σ: write 1σ", "(ISO 9283, 1σ:", "(1σ)", "with 95 % intervals", "exit status 1", "SHA-256", "chooses 3 more",
]


class Answers:
    def __init__(self, program, source, folder):
        self.program, self.folder = program, folder
        for file in (source / "examples" / "kr270").iterdir():
            shutil.copy(file, folder)

    @functools.cache
    def run(self, words):
        done = subprocess.run([self.program, *words.split()], cwd=self.folder, capture_output=True, text=True)
        assert done.returncode == 0, f"{words}: {done.stderr}"
        return done.stdout

    @functools.cache
    def edited(self, name, *changes):
        text = (self.folder / "problem.yaml").read_text()
        for pattern, by in changes:
            text, count = re.subn(pattern, by, text)
            assert count, pattern
        (self.folder / name).write_text(text)
        return name

    def find(self, pattern, words):
        return re.search(pattern, self.run(words))[1]

    @functools.cache
    def plan(self, problem="problem.yaml", more="--proof-time 0"):
        """The plan of 18 poses, as JSON."""
        return json.loads(self.run(f"plan {problem} --poses 18 {SMALL} {more} --json -o - --poses-csv {problem}.csv --force"))

    def first_hour(self, more=""):
        self.run("init kr270.urdf --tracker -o hour.yaml --force")
        return self.run(f"plan hour.yaml -o - --poses-csv - {more}")

    def least_poses(self, problem):
        return self.find(r"(\d+) poses at least", f"observe {problem} --variant geometric")

    # One method an answer; it returns what the page says in the figures that it found.

    def version(self):
        return f"Figures are of version {self.run('--version').split()[1]},"

    def how_many(self):
        one = self.edited("one.yaml", (r"    P[23]:.*\n", ""))
        return f"({self.least_poses('problem.yaml')} for the KR 270 with three reflectors, {self.least_poses(one)} with one)"

    @functools.cache
    def curve(self):
        self.run("init kr270.urdf --tracker --accuracy 0.02mm -o accuracy.yaml --force")
        return self.run("plan accuracy.yaml -o - --poses-csv -")

    def how_much_worse(self):
        at = dict(re.findall(r"^ +(\d+) +[\d.]+ +([\d.]+) mm +(?:yes|no)", self.curve(), re.M))
        enough = re.match(r"(\d+) poses", self.curve())[1]
        return f"with 5 poses the arm of [the first hour](getting-started.md) comes out {float(at['5']) / float(at[enough]):.1f} times worse than with {enough}."

    def as_many_as_it_takes(self):
        enough = re.match(r"(\d+) poses", self.curve())[1]
        return f"gave {enough}, and the curve"

    def random_poses(self):
        bound = self.plan()["certificate"]["candidates"]["log_det_bound"]
        shares = []
        for seed in range(1, 6):
            few = f"--poses 18 --candidates 18 --method exchange --proof-time 0 --seed {seed} --json -o - --poses-csv -"
            shares.append(100 * math.exp((json.loads(self.run(f"plan problem.yaml {few}"))["criterion"]["log_det"] - bound) / 18))
        planned = 100 * self.plan()["certificate"]["candidates"]["efficiency"]
        return (f"Five random sets of 18 poses of the KR 270 (`--candidates 18`, `--seed` 1 to 5) are at least {min(shares):.0f} to {max(shares):.0f} % as "
                f"informative as any 18 of 1,000 candidates, by the same bound as the planned set with at least {planned:.2f} %. "
                f"Information adds up over poses: 50 % means twice as many")

    def scaling(self):
        self.plan()
        poses = [(self.folder / "problem.yaml.csv").read_bytes()]
        for scaling in ("norm", "none"):
            self.run(f"plan problem.yaml --poses 18 {SMALL} --proof-time 0 --scaling {scaling} -o - --poses-csv {scaling}.csv --force")
            poses.append((self.folder / f"{scaling}.csv").read_bytes())
        return "Nothing in an O1 plan: the same poses come out with" if poses[0] == poses[1] == poses[2] else "Much"

    def certificate(self):
        plan = self.first_hour("--criterion o1 --candidates 500 --method exchange --restarts 2")
        share, poses, candidates = re.search(r"At least ([\d.]+) % as informative as any plan of (\d+) of these (\d+)", plan).groups()
        return (f"\"At least {share} % as informative as any plan of {poses} of these {candidates} candidates\" ([the first hour](getting-started.md) by `--criterion o1 --candidates {candidates} --method exchange --restarts 2`) is a proof by "
                f"the equivalence theorem: no set of {poses} of these candidates, ever found or not, has more than 1/{float(share) / 100:.4f} times")

    def default_noise(self):
        self.first_hour()
        along, growth, across, more = re.search(r"([\d.]+) um \+ ([\d.]+) um/m along the beam, ([\d.]+) um \+ ([\d.]+) um/m across",
                                                (self.folder / "hour.yaml").read_text()).groups()
        return f"without `noise` takes {along} µm + {growth} µm/m along the beam and {across} µm + {more} µm/m across"

    def twice_the_noise(self):
        noisy = self.plan(self.edited("noise.yaml", ('"0.1 mm"', '"0.2 mm"')))
        same = (self.folder / "noise.yaml.csv").read_bytes() == (self.folder / "problem.yaml.csv").read_bytes()
        ratios = [a["sigma"] / b["sigma"] for a, b in zip(noisy["parameters"], self.plan()["parameters"])]
        assert len(ratios) >= 33 and all(abs(ratio - 2) < 1e-6 for ratio in ratios), ratios
        return f"twice the noise gives the same {len(noisy['poses'])} poses and twice every σ" if same else "other poses"

    def base_known(self):
        known = self.plan(self.edited("base.yaml", (r'\["base\.\*", "target\.\*"\]', '["target.*"]')))
        gain = (known["criterion"]["log_det"] - self.plan()["criterion"]["log_det"]) / 18
        return f"best plan would look {100 * math.expm1(gain):.0f} % more informative"

    def a_pose_fails(self):
        least = min(pose["efficiency_without"] for pose in self.plan()["poses"])
        return f"at the KR 270 {100 * least:.2f} % or more for any one of {len(self.plan()['poses'])})"

    def rejected(self):
        rows = re.findall(r"^  (\S.*?) +\d+ +([\d.]+ %)$", self.first_hour(), re.M)
        return "most first (in [the first hour](getting-started.md): " + ", ".join(f"{why} {share}" for why, share in rows[:2]) + ")"

    def other_nominal_model(self):
        urdf = (self.folder / "kr270.urdf").read_text()
        assert urdf.count("1.250 0 0") == 1
        (self.folder / "long.urdf").write_text(urdf.replace("1.250 0 0", "1.253 0 0"))
        long, drawn = self.plan(self.edited("long.yaml", ("kr270.urdf", "long.urdf"))), self.plan()
        same = (self.folder / "long.yaml.csv").read_bytes() == (self.folder / "problem.yaml.csv").read_bytes()
        assert abs(long["certificate"]["candidates"]["efficiency"] - drawn["certificate"]["candidates"]["efficiency"]) < 5e-5
        return (f"with the upper arm 3 mm longer the same {len(long['poses']) if same else 0} poses of the KR 270 have a log det of {long['criterion']['log_det']:.3f} "
                f"in place of {drawn['criterion']['log_det']:.3f}, and the same certified {100 * long['certificate']['candidates']['efficiency']:.2f} %")

    def said(self):
        names = ("version how_many how_much_worse as_many_as_it_takes random_poses scaling certificate default_noise twice_the_noise "
                 "base_known a_pose_fails rejected other_nominal_model")
        return {name: getattr(self, name)() for name in names.split()}


def complaints(text, said, curve):
    found, explained = [], []
    for name, phrase in said.items():
        places = figures.spans(text, phrase)
        explained += places
        if not places:
            found.append(f"{name}: the page does not say \"{phrase}\"")
    for begin, end, lines in figures.indented_blocks(text):
        explained.append((begin, end))
        found += figures.missing_lines(lines, curve)
    for phrase in DEFINITIONS:
        places = figures.spans(text, phrase)
        explained += places
        if not places:
            found.append(f"the page does not have the definition \"{phrase}\"")
    return found + figures.unexplained(text, explained)


def main(source, program):
    source, program = pathlib.Path(source).resolve(), str(pathlib.Path(program).resolve())
    text = (source / "docs" / "faq.md").read_text()
    with tempfile.TemporaryDirectory() as folder:
        answers = Answers(program, source, pathlib.Path(folder))
        said, curve = answers.said(), answers.curve()
    check = functools.partial(complaints, said=said, curve=curve)
    found = check(text) or [f"may be changed unseen: {figure}" for figure in figures.unnoticed(text, check)]
    print("\n".join(found) or f"{len(said)} answers, {len(figures.NUMBER.findall(figures.masked(text)))} numbers")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
