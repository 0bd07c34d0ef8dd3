"""The Debian packages hold what belongs to them, depend on what they need, and lintian has nothing to say:
check_deb.py FOLDER SOURCE, FOLDER with the packages."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from debian import packages, run

HELD = {
    "posewright": [
        "usr/bin/posewright", "usr/share/bash-completion/completions/posewright", "usr/share/zsh/site-functions/_posewright",
        "usr/share/man/man1/posewright.1.gz", "usr/share/posewright/schemas/problem.schema.json",
        "usr/share/posewright/schemas/plan.schema.json", "usr/share/posewright/examples/telescope/problem.yaml",
        "usr/share/posewright/examples/kr270/kr270.urdf", "usr/share/doc/posewright/README.md",
        "usr/share/doc/posewright/report-licenses.txt", "usr/share/doc/posewright/docs/problem-file.md"],
    "libposewright-dev": [
        "usr/include/posewright/version.hpp", "usr/include/posewright/planners/planner_registry.hpp",
        "usr/lib/ARCH/libposewright.a", "usr/lib/ARCH/cmake/posewright/posewright-config.cmake",
        "usr/lib/ARCH/cmake/posewright/posewright-targets.cmake", "usr/lib/ARCH/cmake/posewright/dependencies.cmake"],
    "python3-posewright": ["usr/lib/python3/dist-packages/posewright/__init__.py", "usr/lib/python3/dist-packages/posewright/py.typed"],
    "posewright-mpi": ["usr/lib/posewright/modules/posewright_mpi.so"]}
# Their numbers differ between releases of Debian.
LIBRARIES = (r"libc6", r"libompl\d+", r"libfcl0\.\d", r"libnlopt0", r"libyaml-cpp0\.\d")


def depends(file):
    return [part.strip() for part in run("dpkg-deb", "-f", file, "Depends").split(",")]


def check_contents(made, source):
    architecture = run("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
    seen = {}
    for package, file in made.items():
        entries = [line.split(maxsplit=5) for line in run("dpkg-deb", "-c", file).splitlines()]
        paths = {entry[5].removeprefix("./") for entry in entries if not entry[0].startswith("d")}
        for name in ("copyright", "changelog.gz", "changelog.Debian.gz"):
            assert f"usr/share/doc/{package}/{name}" in paths, f"{package} has no {name}"
        for path in HELD[package]:
            assert path.replace("ARCH", architecture) in paths, f"{path} is not in {package}"
        for path in paths:
            assert seen.setdefault(path, package) == package, f"{path} is in {seen[path]} and in {package}"
    # Sources have headers and Python files of two packages; all of them must have come along.
    headers = {str(f.relative_to(source / "include")) for f in (source / "include").rglob("*.hpp")}
    assert {f"usr/include/{h}" for h in headers} <= {p for p, owner in seen.items() if owner == "libposewright-dev"}
    modules = {str(f.relative_to(source / "python")) for f in (source / "python/posewright").rglob("*.py")}
    assert {f"usr/lib/python3/dist-packages/{m}" for m in modules} <= set(seen)


def check_dependencies(made, source):
    for package in ("posewright", "python3-posewright"):
        for library in LIBRARIES:
            assert any(re.match(rf"{library} \(>= ", part) for part in depends(made[package])), f"{package}: {library}"
    needed = depends(made["python3-posewright"])
    assert "python3-numpy" in needed and any(part.startswith("python3 (<< 3.") for part in needed), needed
    # A consumer finds what the library itself was built with.
    setup = (source / "scripts/setup").read_text()
    built_with = {name for name in re.search(r"packages='(.*?)'", setup, re.S).group(1).split() if name.endswith("-dev")}
    built_with.remove("musl-dev")  # its objects are in the library
    assert set(depends(made["libposewright-dev"])) == built_with, set(depends(made["libposewright-dev"])) ^ built_with


def check_stripped(made):
    with tempfile.TemporaryDirectory() as name:
        for package in ("posewright", "python3-posewright"):
            run("dpkg-deb", "-x", made[package], name)
        root = pathlib.Path(name)
        for file in (root / "usr/bin/posewright", *root.rglob("_core*.so")):
            assert ", stripped" in run("file", file), file


def check_lintian(made):
    """Not one error, warning or override."""
    if shutil.which("lintian") is None:
        print("lintian is missing: the packages were not checked by it")
        return
    done = subprocess.run(["lintian", "--allow-root", "--show-overrides", "--fail-on", "error,warning,override", *map(str, made.values())],
                          capture_output=True, text=True)
    assert done.returncode == 0 and not done.stdout, done.stdout + done.stderr


if __name__ == "__main__":
    made, source = packages(pathlib.Path(sys.argv[1])), pathlib.Path(sys.argv[2])
    check_contents(made, source)
    check_dependencies(made, source)
    check_stripped(made)
    check_lintian(made)
