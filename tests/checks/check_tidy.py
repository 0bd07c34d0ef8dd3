"""clang-tidy on what the last commit changed: check_tidy.py SOURCE BUILD [FILE…]. Without history: on ten files that are named here.
77: the tool is missing."""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

from changes import changed, include_flags

# One of each kind, for a tree without history.
FIXED = ["src/support/file.cpp", "src/blocks/csv.cpp", "src/problem/units.cpp", "src/model/whitening.cpp", "src/model/srdf.cpp",
         "src/workspace/limits.cpp", "src/criterion/design_state.cpp", "planners/greedy.cpp", "src/support/table.cpp", "src/cli/terminal.cpp"]
# Of a large change the first so many: each takes a processor some ten seconds.
MOST = 6


def main(source, build, *named):
    root = pathlib.Path(source)
    tool = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    if tool is None:
        print("Skipped: clang-tidy is missing (scripts/setup test installs it).")
        sys.exit(77)
    names = named or changed(root)
    files = [f for f in (FIXED if names is None else names) if f.endswith(".cpp") and f.split("/")[0] in ("src", "planners")]
    flags = ["-std=c++20", *include_flags(build)]

    def check(file):
        run = subprocess.run([tool, "--quiet", "--warnings-as-errors=*", str(root / file), "--", *flags], capture_output=True, text=True)
        return file, "" if run.returncode == 0 else run.stdout + run.stderr

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(check, files if names is None else files[:MOST]))
    for file, text in results:
        print(f"{file}: {text[:3000] if text else 'nothing'}")
    sys.exit(1 if any(text for _, text in results) else 0)


main(*sys.argv[1:])
