"""init --show: init_show.py PROGRAM SOURCE.

An installation with a page of one line in the place of posewright.html: the problem and its files are in the page that is written,
byte for byte; the browser gets its path; without a screen the path is printed; without the page one line says so."""
import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
urdf = source / "examples/kr270/kr270.urdf"


def given(page):
    data = re.search(r"<b>(.*)</b>", page.read_text()).group(1)
    assert "<" not in data
    data = json.loads(data)
    return data["problem"], {name: base64.b64decode(text) for name, text in data["files"].items()}


with tempfile.TemporaryDirectory() as temporary:
    root = pathlib.Path(temporary).resolve()
    own, work, robots, tools = (root / name for name in ("own/bin", "work", "robots", "tools"))
    for folder in (own, work, robots / "a/b", tools):
        folder.mkdir(parents=True)
    shutil.copy(program, own / "posewright")
    shutil.copy(urdf, work)
    (tools / "xdg-open").write_text(f'#!/bin/sh\necho "$1" > {root}/opened\nsleep 5\n')
    (tools / "xdg-open").chmod(0o755)
    quiet = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")}
    screen = {**quiet, "DISPLAY": ":9", "PATH": f"{tools}:{os.environ['PATH']}"}

    def init(*words, env=screen):
        return subprocess.run([own / "posewright", "init", *words, "--tracker", "--yes", "--poses", "12"], cwd=work, env=env,
                              capture_output=True, text=True)

    missing = init("kr270.urdf", "--show")
    assert missing.returncode == 1 and "posewright.html" in missing.stderr and missing.stderr.count("\n") == 1, missing
    assert not (work / "problem.yaml").exists(), "nothing is written"

    page = root / "own/share/posewright/posewright.html"
    page.parent.mkdir(parents=True)
    page.write_text("<!doctype html><b>@GIVEN_PROJECT@</b>\n")
    start = time.monotonic()
    shown = init("kr270.urdf", "--show")
    assert shown.returncode == 0, shown
    assert "problem.html is opened in the browser" in shown.stdout, shown.stdout
    assert time.monotonic() - start < 5, "the browser is not waited for"
    for _ in range(50):
        if (root / "opened").exists() and (root / "opened").read_text().endswith("\n"):
            break
        time.sleep(0.1)
    assert (root / "opened").read_text() == f"{work}/problem.html\n"
    problem, files = given(work / "problem.html")
    assert problem == "problem.yaml" and files.keys() == {"problem.yaml", "kr270.urdf"}, files.keys()
    assert all(files[name] == (work / name).read_bytes() for name in files)

    again = init("kr270.urdf", "--show")
    assert again.returncode == 1 and "exists; --force" in again.stderr, again
    # A robot from elsewhere has a name in the page that is below its root; the file on the disk keeps its own.
    shutil.copy(urdf, robots / "a/b/arm.urdf")
    for name in ("../robots/a/b/arm.urdf", str(robots / "a/b/arm.urdf")):
        other = init(name, "--show", "--force", "--json", "-o", "other.yaml", env=quiet)
        assert other.returncode == 0 and json.loads(other.stdout)["page"] == "other.html", other
        problem, files = given(work / "other.html")
        inside = re.search(r"^  urdf: (\S+)", files["other.yaml"].decode(), re.M).group(1).strip("'\"")
        assert files[inside] == urdf.read_bytes() and not inside.startswith(("/", "..")), inside
        assert inside not in (work / "other.yaml").read_text().replace(str(robots), ""), "the file on the disk is as ever"
    printed = init("kr270.urdf", "--show", "--force", env=quiet)
    assert printed.returncode == 0 and f"{work}/problem.html" in printed.stdout and "No browser" in printed.stdout, printed
    nowhere = init("kr270.urdf", "--show", "-o", "-")
    assert nowhere.returncode == 2 and "--show" in nowhere.stderr, nowhere
