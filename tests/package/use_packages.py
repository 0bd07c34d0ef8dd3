"""The packages are installed with apt into an empty root and used there: use_packages.py REPOSITORY SOURCE SCRATCH.

The root holds what Debian calls essential, the three packages, what they depend on, and a compiler: nothing of this machine."""
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys

from debian import need, packages, run, skip

need(mmdebstrap="mmdebstrap")
if os.geteuid() != 0:
    skip("only root can change the root folder")
repository, source, scratch = map(pathlib.Path, sys.argv[1:])
made = packages(repository)
if scratch.exists():
    shutil.rmtree(scratch)

suite = platform.freedesktop_os_release()["VERSION_CODENAME"]
# Debian's packages come from where this machine has them from.
sources = [file for file in (pathlib.Path("/etc/apt/sources.list.d/debian.sources"), pathlib.Path("/etc/apt/sources.list"))
           if file.exists() and "deb" in file.read_text()]
ours = f"deb [signed-by={repository}/posewright.asc] copy:{repository} ./"
left_out = [f"--dpkgopt=path-exclude=/usr/share/{part}/*" for part in ("man", "locale", "doc")]
done = subprocess.run(
    ["mmdebstrap", "--variant=essential", "--aptopt=APT::Install-Recommends \"false\"", "--dpkgopt=force-unsafe-io", *left_out,
     "--include=" + ",".join([*made, "g++", "cmake", "ninja-build"]), suite, str(scratch), *map(str, sources[:1]), ours],
    capture_output=True, text=True)
if re.search("Temporary failure resolving|Could not resolve|Could not connect|Network is unreachable", done.stderr):
    skip("Debian's packages are out of reach")
assert done.returncode == 0, done.stderr[-4000:]


def inside(*words):
    return run("chroot", scratch, *words, env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/tmp", "LC_ALL": "C.UTF-8"})


states = inside("dpkg-query", "-W", "-f", "${Package} ${db:Status-Abbrev}\n", *made).split()
assert states == [word for package in sorted(made) for word in (package, "ii")], states

# The program, on an example that came with it.
example = "/usr/share/posewright/examples/five_bar"
plan = inside("sh", "-c", f"cd /tmp && posewright plan {example}/problem.yaml --candidates 100 --method greedy && cat poses.csv")
assert "12 poses for variant" in plan and plan.splitlines()[-1].startswith("12,"), plan
schema = (scratch / example[1:] / "problem.yaml").read_text().split("\n")[0].split("$schema=")[1]
assert (scratch / example[1:] / schema).resolve().is_file(), "the example's schema is not installed"

# The Python package, compiled by its postinst.
said = inside("python3", "-c", f"import posewright as pw; print(len(pw.plan(pw.Problem('{example}/problem.yaml'), candidates=100, "
                               "method='greedy')), pw.__file__)")
assert said.split() == ["12", "/usr/lib/python3/dist-packages/posewright/__init__.py"], said
assert list((scratch / "usr/lib/python3/dist-packages/posewright/__pycache__").glob("__init__.*.pyc"))

# The library: a program of ten lines finds it.
shutil.copytree(source / "tests/package/consumer", scratch / "tmp/consumer")
shutil.copy(source / "README.md", scratch / "tmp")
inside("cmake", "-G", "Ninja", "-S", "/tmp/consumer", "-B", "/tmp/built", "-DREADME=/tmp/README.md")
inside("cmake", "--build", "/tmp/built", "--target", "consumer")
said = inside("/tmp/built/consumer")
assert re.match("0.25 .*exchange", said), said

# And they go as they came.
inside("dpkg", "--purge", *made)
assert not list(scratch.glob("usr/**/posewright*")), list(scratch.glob("usr/**/posewright*"))
shutil.rmtree(scratch)
