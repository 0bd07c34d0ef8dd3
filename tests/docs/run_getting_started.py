"""Runs the sh blocks of docs/getting-started.md one after the other in an empty folder: run_getting_started.py SOURCE PROGRAM."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def main(source, program):
    root = pathlib.Path(source).resolve()
    text = (root / "docs/getting-started.md").read_text()
    blocks = re.findall(r"^```sh\n(.*?)^```$", text, re.S | re.M)
    assert len(blocks) >= 6, "the page has lost its commands"
    script = "set -e\n" + "".join(blocks).replace("/usr/share/posewright/examples", f"{root}/examples")
    with tempfile.TemporaryDirectory() as folder:
        path = f"{pathlib.Path(program).resolve().parent}:{os.environ['PATH']}"
        run = subprocess.run(["sh", "-c", script], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True)
        print(run.stdout, run.stderr)
        assert run.returncode == 0
        # What the page says is printed, is.
        promised = [line[4:] for line in text.splitlines() if re.match(r"    (20 poses|At least|Over the whole)", line)]
        assert len(promised) == 3
        for line in promised:
            assert line in run.stdout, f"not printed: {line}"
        assert "rank 33 of 57 parameters" in run.stdout and "Smallest number of poses: 5" in run.stdout
        for name in ("plan.json", "poses.csv", "route.json"):
            assert (pathlib.Path(folder) / "my_robot" / name).is_file(), name


main(*sys.argv[1:])
