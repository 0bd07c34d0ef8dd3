"""The commands of README and docs run as they are written: run_documented.py SOURCE PROGRAM [PAGE…]; SOURCE --list PAGE…
compares the pages that have commands with a list, and what is shortened with what the pages have. Of the first hour
every figure is compared with what the commands print, of README the first lines of the plan.

A page's commands are its ```sh blocks and its indented lines that begin with `posewright`, in their order, in one shell and one
folder that holds `examples` and the files that the page's reader has by then. Commands that take long are listed here, once."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import figures

QUICK = "--candidates 100 --method exchange --restarts 1"
# Searches that take more than some seconds as they stand: words that are added, or take the place of the option's own.
SLOW = {
    "posewright plan examples/kr270/problem.yaml -o": "--time-limit 3",
    "posewright plan examples/kr270/problem.yaml --poses 18": "--time-limit 3",
    "posewright stations examples/cell/problem.yaml": "--candidates 20 --restarts 1 --full 0",
    "posewright compare examples/telescope/problem.yaml --variant rigid,linear,matrix": QUICK,
    "posewright evaluate examples/": QUICK,
    "posewright evaluate problem.yaml poses.yaml": QUICK,
    "posewright plan problem.yaml --poses 24 --fixed": "--time-limit 3",
    "posewright simulate examples/kr270/problem.yaml plan.json --draws 5000": "--draws 200",
    "posewright simulate examples/telescope/problem.yaml plan.json": "--draws 20",
    "posewright simulate examples/telescope/problem.yaml rigid.json": "--draws 20",
    "posewright simulate problem.yaml plan.json --draws 100000": "--draws 40",
    "posewright plan problem.yaml --parameters": "--time-limit 3",
    "posewright plan problem.yaml --poses 12 --candidates-from": "--time-limit 3",
    "posewright select blocks.npy": "--time-limit 3",
}

# Between the outputs of two commands.
NEXT_PRINTED = "\x1e"
NEXT = "printf '\\036'\n"

KR270 = f"posewright plan examples/kr270/problem.yaml {QUICK}"
TELESCOPE = f"posewright plan examples/telescope/problem.yaml {QUICK}"
BLOCKS = "/usr/bin/python3 -c 'import numpy; numpy.save(\"{}\", numpy.random.default_rng(1).normal(size=(500, 3, 12)))'\n"
READINGS = "posewright simulate examples/kr270/problem.yaml plan.json --draws 2 --data {}\n"
OWN = "cp examples/kr270/* .\n"
ROUTED = f"posewright plan examples/cell/problem.yaml {QUICK} -o plan.json\nposewright route plan.json -o route.json\n"

# What the reader of a page has before its first command.
BEFORE = {
    "docs/calibrate.md": OWN + KR270 + "\n" + READINGS.format("measured.csv") + READINGS.format("later.csv --seed 2"),
    "docs/commands.md": OWN + BLOCKS.format("blocks.npy") + KR270 + " --poses 40\n" + READINGS.format("measured.csv")
    + READINGS.format("more.csv --seed 2") + f"posewright plan examples/kr270/problem.yaml {QUICK} --poses 20 -o - --poses-csv data.csv\n",
    "docs/cluster.md": OWN + KR270 + "\n",
    "docs/next.md": OWN,
    "docs/compensate.md": OWN + KR270 + "\n" + READINGS.format("measured.csv") + "posewright route plan.json -o route.json\n"
    + "posewright export route.json --to kuka-krl --controller kuka-kr-c4 -o WELD.src\n",
    "docs/compare.md": TELESCOPE + "\n" + TELESCOPE + " --seed 2 -o - --poses-csv mine.csv\n",
    "docs/export.md": OWN + KR270 + "\nposewright route plan.json -o route.json\n",
    "docs/parameters-file.md": OWN + KR270 + "\n" + READINGS.format("measured.csv")
    + "posewright calibrate problem.yaml measured.csv -o calibrated.yaml\n",
    "docs/report.md": ROUTED + OWN + f"{KR270} -o a.json --poses-csv -\n{KR270} --seed 2 -o b.json --poses-csv -\n"
    + READINGS.format("measured.csv").replace("plan.json", "a.json")
    + "posewright calibrate problem.yaml measured.csv --json > calibration.json\n",
    "docs/reproduction-kr270.md": "",
    "docs/reproduction-telescope.md": "",
    "docs/simulate.md": "",
}
# In front of every command that begins so, on all pages: ways to each of the candidates of nine places take minutes.
FIRST = {"posewright stations examples/cell": "sed -i 's/reachable: true/reachable: false/' examples/cell/problem.yaml\n"}
# A program whose poses no time limit chose: where they are, all of them can be compensated.
TAUGHT = f"{KR270} -o taught.json --poses-csv - --force\nposewright export taught.json --to kuka-krl -o program.src\n"
# What a page's reader has only by then: in front of the command that begins so.
BETWEEN = {
    ("README.md", "posewright calibrate"): READINGS.format("measured.csv"),
    ("README.md", "posewright compensate"): TAUGHT,
    ("docs/commands.md", "posewright compensate"): "posewright calibrate problem.yaml measured.csv -o calibrated.yaml\n"
    + TAUGHT,
    ("docs/commands.md", "posewright evaluate examples/telescope"): f"{TELESCOPE} -o - --poses-csv poses.csv --force\n",
    ("docs/commands.md", "posewright simulate"): f"{KR270} -o plan.json --poses-csv - --force\n",
    ("docs/commands.md", "posewright export"): ROUTED.replace("-o plan.json", "-o plan.json --poses-csv - --force"),
    ("docs/next.md", "posewright next problem.yaml --data measured.csv -k 2"): "posewright simulate problem.yaml next.csv --draws 2 --data measured.csv\n",
    ("docs/simulate.md", "posewright simulate examples/telescope"): f"{TELESCOPE} --variant rigid -o plan.json --poses-csv - --force\n",
}


def commands_of(text):
    """Whole sh blocks, and indented commands one by one."""
    found = re.finditer(r"^```sh\n(.*?)^```$|^    (posewright [^\n]*\n)", text, re.S | re.M)
    return [match[1] if match[1] is not None else match[2] for match in found]


def as_tested(command):
    for begin, words in SLOW.items():
        at = command.find(begin)
        if at >= 0:
            end = re.compile(r"\s+#|\n").search(command, at).start()
            own = command[at:end]
            for option in re.findall(r"--\S+", words):
                own = re.sub(rf" {option} \S+", "", own)
            command = f"{command[:at]}{own} {words}{command[end:]}"
    return command


def run_page(root, page, path):
    lines = [NEXT]
    for command in commands_of((root / page).read_text()):
        for (where, begin), between in BETWEEN.items():
            if where == page and command.startswith(begin):
                lines.append(between)
        for begin, before in FIRST.items():
            command = command.replace(begin, before + begin)
        lines += [as_tested(command), NEXT]
    script = "set -e\n" + BEFORE.get(page, "") + "".join(lines)
    script = script.replace('export PATH="$PWD/build/release/bin:$PATH"\n', "").replace("/usr/share/posewright/examples", f"{root}/examples")
    # Said once a line, so that a failure names its command.
    script = script.replace("set -e\n", "set -ex\n", 1)
    if os.environ.get("SECONDS_OF_EACH"):
        script = "PS4='+ $(date +%T) '\n" + script
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(root / "examples", pathlib.Path(folder) / "examples")
        run = subprocess.run(["sh", "-c", script], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True)
        if os.environ.get("SECONDS_OF_EACH"):
            print(run.stderr)
        if run.returncode != 0:
            print(f"{page}: status {run.returncode}\n{run.stderr[-2000:]}")
        written = {str(p.relative_to(folder)): p.read_text(errors="replace") for p in pathlib.Path(folder).rglob("*")
                   if p.is_file() and not str(p.relative_to(folder)).startswith("examples/")}
        return run, written


# Numbers of the first hour that say what is meant, and are no result.
DEFINITIONS = ["Debian 12 or 13", "Debian 12", "for 20 robots drawn", "KR 270", "its 95 % interval", "first of the 200 virtual robots"]


def first_hour_complaints(text, outputs, written):
    """What the page of the first hour says otherwise than its commands: each indented block and quotation is of the output of
    the commands in front of it, each line of YAML stands in a file that they wrote."""
    found, explained = [], []
    ends = [match.end() for match in re.finditer(r"^```sh\n.*?^```$|^    posewright .*\n", text, re.S | re.M)]
    printed = lambda place: outputs[sum(end <= place for end in ends)]
    for begin, end, lines in figures.indented_blocks(text):
        explained.append((begin, end))
        found += figures.missing_lines(lines, printed(begin))
    for match in re.finditer(r"\"([^\"\n]*)\"", figures.masked(text)):
        explained.append(match.span())
        if figures.squeezed(match[1]) not in figures.squeezed(printed(match.start())):
            found.append(f"not printed: {match[1]}")
    files = [without_comments(file) for name, file in written.items() if name.endswith(".yaml")]
    for match in re.finditer(r"^```yaml\n(.*?)^```$", text, re.S | re.M):
        if not any(match[1] in file for file in files):
            found.append(f"in no file: {match[1]}")
    for phrase in DEFINITIONS:
        explained += figures.spans(text, phrase)
    return found + figures.unexplained(text, explained)


def without_comments(yaml):
    lines = [re.sub(r"\s+#.*|^#.*", "", line) for line in yaml.splitlines()]
    return "".join(line + "\n" for line in lines if line.strip())


def check_first_hour(text, run, written):
    outputs = run.stdout.split(NEXT_PRINTED)
    found = first_hour_complaints(text, outputs, written)
    assert not found, "\n".join(found)
    unseen = figures.unnoticed(text, lambda changed: first_hour_complaints(changed, outputs, written))
    assert not unseen, f"may be changed unseen: {unseen}"
    for name in ("my_robot/plan.json", "my_robot/poses.csv", "my_robot/route.json", "my_robot/CALPOSES.src", "my_robot/calibrated.yaml",
                 "my_robot/corrected/CALPOSES.dat", "my_robot/calibrated.urdf", "my_camera/camera.yaml", "my_camera/corrected/ARMPOSES.dat"):
        assert name in written, name


def check_first_lines(text, root, path):
    """A command in the prose, `of COMMAND:` and an indented block: the commands one after the other print these lines, and would
    not print others."""
    quoted = re.search(r"^`(posewright init [^`]*)`.* of `(posewright plan [^`]*)`:\n\n((?:    .*\n)+)", text, re.M)
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(root / "examples", pathlib.Path(folder) / "examples")
        for command in quoted[1], quoted[2]:
            output = subprocess.run([*command.split(), "--quiet"], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True,
                                    text=True, check=True).stdout
    complaints = lambda block: figures.missing_lines(block.splitlines(), output)
    assert not complaints(quoted[3]), "\n".join(complaints(quoted[3]))
    unseen = figures.unnoticed(quoted[3], complaints)
    assert not unseen, f"may be changed unseen: {unseen}"


def main(source, program, *pages):
    root = pathlib.Path(source).resolve()
    every = ["README.md"] + sorted(f"docs/{p.name}" for p in (root / "docs").glob("*.md"))
    every = [page for page in every if commands_of((root / page).read_text())]
    if program == "--list":
        text = "".join(command for page in every for command in commands_of((root / page).read_text()))
        unused = [begin for begin in SLOW if begin not in text]
        sys.exit(0 if every == list(pages) and not unused else f"pages with commands: {every}; no page has: {unused}")
    path = f"{pathlib.Path(program).resolve().parent}:{os.environ['PATH']}"
    chosen = list(pages) or every
    bad = []
    for page in chosen:
        run, written = run_page(root, page, path)
        print(f"{page}: {'failed' if run.returncode else 'as written'}", flush=True)
        if run.returncode:
            bad.append(page)
        elif page == "docs/getting-started.md":
            check_first_hour((root / page).read_text(), run, written)
        elif page == "README.md":
            check_first_lines((root / page).read_text(), root, path)
    sys.exit(f"failed: {', '.join(bad)}" if bad else 0)


main(*sys.argv[1:])
