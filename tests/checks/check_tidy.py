"""clang-tidy on what the last commit changed: check_tidy.py SOURCE BUILD [FILE…]. Without history: on ten files that are named here.
77: the tool is missing."""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys

# One of each kind, for a tree without history.
FIXED = ["src/support/file.cpp", "src/blocks/csv.cpp", "src/problem/units.cpp", "src/model/whitening.cpp", "src/cell/srdf.cpp",
         "src/workspace/limits.cpp", "src/criterion/design_state.cpp", "planners/greedy.cpp", "src/outputs/table.cpp", "src/cli/terminal.cpp"]
# Of a large change the first so many: each takes a processor some ten seconds.
MOST = 10


def changed(root):
    run = subprocess.run(["git", "-C", str(root), "diff", "--name-only", "--diff-filter=d", "HEAD~1"], capture_output=True, text=True)
    return run.stdout.split() if run.returncode == 0 else FIXED


def main(source, build, *named):
    root = pathlib.Path(source)
    tool = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    if tool is None:
        print("Skipped: clang-tidy is missing (scripts/setup test installs it).")
        sys.exit(77)
    files = [f for f in (named or changed(root)) if f.endswith(".cpp") and f.split("/")[0] in ("src", "planners")]
    commands = {}
    for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text()):
        commands.setdefault(entry["file"].split(str(root) + "/")[-1].split("/")[0], entry["command"])
    system = sorted({word for entry in commands.values() for word in entry.split() if word.startswith("/usr/include/")})
    flags = ["-std=c++20", f"-I{root}", f"-I{root}/include", f"-I{build}/include", *(f"-isystem{s}" for s in system)]

    def check(file):
        run = subprocess.run([tool, "--quiet", "--warnings-as-errors=*", str(root / file), "--", *flags], capture_output=True, text=True)
        return file, "" if run.returncode == 0 else run.stdout + run.stderr

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(check, files[:MOST]))
    for file, text in results:
        print(f"{file}: {text[:3000] if text else 'nothing'}")
    sys.exit(1 if any(text for _, text in results) else 0)


main(*sys.argv[1:])
