"""A small part of bench/posebench is run again and compared with docs/images/posebench.csv; bad input is named and the rest goes on.

    posebench.py SOURCE PROGRAM"""
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
SOURCE, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2]
DATA = SOURCE.parent / "shared" / "data"
try:
    import numpy  # noqa: F401
    import tomllib  # noqa: F401
    import yaml  # noqa: F401
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml, Python 3.11)")
    sys.exit(77)
failures = 0


def expect(good, text):
    global failures
    print(("ok   " if good else "FAIL ") + text, flush=True)
    failures += not good


def run(folder, *words, data=DATA):
    """Exit code, standard output and errors together, rows."""
    done = subprocess.run([SOURCE / "bench/posebench/run", "--program", PROGRAM, "--data", data, "--out", folder, *words], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    file = folder / "posebench.csv"
    return done.returncode, done.stdout, rows_of(file) if file.is_file() else []


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return {tuple(row[key] for key in ("set", "poses", "solver", "estimation")): row for row in csv.DictReader(file)}


def stored_figures_hold(folder):
    stored, compared = rows_of(SOURCE / "docs/images/posebench.csv"), 0
    for name, more in [("d-leg", [])] + ([("positioner", ["--poses", "6"])] if DATA.is_dir() else []):
        code, said, rows = run(folder, "--sets", name, "--solvers", "posewright-o1,farthest-point,kiefer-greedy", "--calibrated-draws", "2", *more)
        expect(code == 0, f"{name}: exit code {code}")
        for key, row in rows.items():
            by_program = key[3] == "posewright's defaults"
            if by_program and key[2] in ("random", "halves"):
                continue  # fewer draws here
            expect(key in stored, f"{key} is stored")
            for field in ("value",) if by_program else ("value", "better", "efficiency", "merit"):
                if key in stored and row[field]:
                    compared += 1
                    same = abs(float(row[field]) - float(stored[key][field])) <= 0.02 * max(abs(float(row[field])), 0.5)
                    expect(same, f"{key}, {field}: {row[field]}, stored {stored[key][field]}")
    expect(compared > 4, f"{compared} figures compared")


def pages_are_those_of_the_stored_run(folder):
    """Figure, tables of docs/posebench.md, and the rows that README takes from them."""
    sys.path[:0] = [str(SOURCE / "bench/posebench"), str(SOURCE / "bench")]
    import report
    import tomllib
    sets = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted((SOURCE / "bench/posebench/data").glob("*.toml"))}
    rows = report.read(SOURCE / "docs/images/posebench.csv")
    page = (SOURCE / "docs/posebench.md").read_text(encoding="utf-8")
    made = [report.robots_table(rows, report.PLAIN), report.robots_table(rows, report.PROGRAM), report.estimators_table(rows, "posewright"),
            report.instances_table(rows), report.trust_table(rows), report.provenance(rows, sets)]
    expect(all(table.strip() and table.strip() in page for table in made), "tables of docs/posebench.md are those of posebench.csv")
    expect(report.figure(rows, sets) == (SOURCE / "docs/images/posebench.svg").read_text(encoding="utf-8"), "the figure is that of posebench.csv")
    section = (SOURCE / "README.md").read_text(encoding="utf-8").split("## The value of planned poses")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ") and not line.startswith("| ---")]
    expect(len(lines) > 4 and all(line in page for line in lines), f"{len(lines)} rows of README's tables stand in docs/posebench.md")


def estimator_agrees_with_the_program(folder):
    """Plain least squares of numpy, and `calibrate --weights ols --no-prior`, on the same poses of the positioner."""
    sys.path[:0] = [str(SOURCE / "bench/posebench"), str(SOURCE / "bench")]
    import json
    import tomllib

    import estimators
    import measured
    import numpy as np
    path = SOURCE / "bench/posebench/data/positioner.toml"
    description = dict(tomllib.loads(path.read_text()), path=path, name="positioner")
    data = measured.Measured(description, SOURCE, DATA / description["folder"], folder)
    (candidates, judges), = data.folds()
    poses = candidates[np.linspace(0, len(candidates) - 1, 20).astype(int)]
    theta = estimators.plain(data.near[poses], data.left[poses], data.nominal, data.known)
    ours = np.sqrt(data.squares(theta, judges).mean())
    done = subprocess.run([PROGRAM, "calibrate", data.problem, data.table(poses, folder / "fit.csv"), "--validate", data.table(judges, folder / "judge.csv"),
                           "--weights", "ols", "--no-prior", "--profile", "none", "--json", "--quiet"], text=True, capture_output=True)
    rms = next(r["rms"] for r in json.loads(done.stdout)["residuals"] if (r["poses"], r["parameters"], r["kind"]) == ("held back", "calibrated", "m"))
    theirs = 1e3 * 3 ** 0.5 * rms
    expect(abs(ours - theirs) < 0.02 * theirs, f"held-out error of the same poses: {ours:.4f} mm, by calibrate {theirs:.4f} mm")


def an_absent_set_is_named(folder):
    code, said, rows = run(folder, "--sets", "positioner,d-leg", "--solvers", "kiefer-greedy", "--draws", "5", data=folder / "nowhere")
    expect(code == 1 and "set positioner" in said and "no such file" in said, "an absent set is named, exit code 1")
    expect(("d-leg", "40", "kiefer-greedy", "information") in rows, "the other set is run")


def a_changed_file_is_named(folder):
    shutil.copytree(DATA / "rosi_two_axis_positioner", folder / "data" / "rosi_two_axis_positioner", copy_function=shutil.copyfile)
    (folder / "data").chmod(0o755)
    changed = folder / "data" / "rosi_two_axis_positioner" / "measurements.csv"
    changed.parent.chmod(0o755)
    changed.write_text(changed.read_text().replace("1", "2", 1))
    code, said, _ = run(folder, "--sets", "positioner,d-leg", "--solvers", "kiefer-greedy", "--draws", "5", data=folder / "data")
    expect(code == 1 and "set positioner" in said and "sha256 differs" in said, "a changed file is named, exit code 1")


def bad_descriptions_are_named(folder):
    texts = {"unfinished": 'title = "x"\nkind = "rows"\n', "broken": "title = \n", "few": (SOURCE / "bench/posebench/data/d-leg.toml").read_text()}
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text)
    code, said, _ = run(folder, "--sets", ",".join(str(folder / f"{name}.toml") for name in texts), "--solvers", "posewright-o1", "--draws", "5", "--poses", "3")
    expect("set unfinished: " in said and "lacks 'generator'" in said, "a description without a key is named")
    expect("set broken: Invalid value (at line 1" in said, "a description that is no TOML is named")
    expect(code == 1 and "posewright-o1 on few: posewright: 3 poses give 3 equations for 6 parameters" in said, "the solver's own words are passed on")


def bad_solvers_are_named(folder):
    scripts = {"fails": "import sys\nsys.exit('no licence')\n", "endless": "while True:\n    pass\n", "short": "import _task\n_task.write(_task.arguments()[2], [0])\n"}
    for name, text in scripts.items():
        (folder / f"{name}.py").write_text(text)
    code, said, rows = run(folder, "--sets", "d-leg", "--draws", "5", "--limit", "1", "--solvers",
                           ",".join([*(str(folder / f"{name}.py") for name in scripts), "kiefer-greedy"]))
    for text in ("fails on d-leg: no licence", "endless on d-leg: past its time, 1 s", "short on d-leg: 1 different indices"):
        expect(text in said, f"named: {text}")
    expect(code == 1 and ("d-leg", "40", "kiefer-greedy", "information") in rows, "exit code 1, the other solver is run")


def a_wrong_name_is_named(folder):
    code, said, _ = run(folder, "--sets", "fanuk")
    expect(code == 2 and "no set fanuk" in said and "fanuc" in said, "a wrong name: exit code 2, names that exist")


def finished_parts_are_kept(folder):
    """The second run takes the first one's solutions: its CPU seconds are the same to the last digit."""
    call = ("--sets", "d-leg", "--solvers", "kiefer-greedy", "--draws", "5")
    first, second = run(folder, *call)[2], run(folder, *call)[2]
    key = ("d-leg", "40", "kiefer-greedy", "information")
    expect(first[key]["cpu"] == second[key]["cpu"] != "", "the second run is the first one's")


CHECKS = [pages_are_those_of_the_stored_run, stored_figures_hold, an_absent_set_is_named, bad_descriptions_are_named, bad_solvers_are_named, a_wrong_name_is_named, finished_parts_are_kept]
CHECKS += [estimator_agrees_with_the_program, a_changed_file_is_named] if DATA.is_dir() else []
for check in CHECKS:
    with tempfile.TemporaryDirectory() as scratch:
        check(pathlib.Path(scratch))
if not DATA.is_dir():
    print(f"skipped: measured sets; they are not at {DATA}")
sys.exit(1 if failures else 0)
