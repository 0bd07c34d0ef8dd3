"""Headers compile alone: check_headers.py SOURCE BUILD COMPILER [--all]. Those that the last commit changed; --all: every one, minutes."""
import concurrent.futures
import os
import pathlib
import subprocess
import sys

from changes import changed, include_flags

# Of a large change, and of a tree without history, the first so many.
MOST = 20


def main(source, build, compiler, every=""):
    root = pathlib.Path(source)
    headers = sorted(p for part in ("include", "planners", "src", "tests/kit") for p in (root / part).rglob("*.hpp"))
    assert len(headers) > 150
    if every != "--all":
        names = changed(root)
        headers = [h for h in headers if names is None or str(h.relative_to(root)) in names][:MOST]
    words = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-x", "c++", f'-DPOSEWRIGHT_SOURCE_DIR="{root}"', *include_flags(build)]

    def check(header):
        run = subprocess.run([*words, "-I", str(header.parent), "-I", str(root / "src/results"), "-"], input=f'#include "{header}"\n',
                             capture_output=True, text=True)
        return header, run.stderr if run.returncode else ""

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        bad = [(h, text) for h, text in pool.map(check, headers) if text]
    for header, text in bad:
        print(f"{header.relative_to(root)} does not compile alone:\n{text[:1500]}")
    sys.exit(1 if bad else 0)


main(*sys.argv[1:])
