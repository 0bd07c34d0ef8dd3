"""The C++ of docs/extending.md compiles: compile_skeletons.py SOURCE BUILD COMPILER [INCLUDE FOLDER…]."""
import pathlib
import re
import subprocess
import sys
import tempfile


def main(source, build, compiler, *folders):
    root = pathlib.Path(source)
    includes = [root, root / "include", root / "planners", pathlib.Path(build) / "include"]
    includes += [root / "src" / part for part in ("cli", "workspace", "formats")] + list(folders)
    blocks = re.findall(r"```cpp\n(.*?)```", (root / "docs/extending.md").read_text(), re.S)
    assert len(blocks) >= 6
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for block in blocks:
            file = pathlib.Path(folder) / "skeleton.cpp"
            file.write_text(block)
            run = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wno-sign-conversion",
                                  "-Wshadow", "-Werror", *(word for i in includes for word in ("-isystem" if str(i).startswith("/usr") else "-I", str(i))),
                                  str(file)], capture_output=True, text=True)
            if run.returncode != 0:
                bad += 1
                print(f"{block[:400]}\n…\n{run.stderr[:3000]}")
    sys.exit(1 if bad else 0)


main(*sys.argv[1:])
