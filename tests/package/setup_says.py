"""What somebody reads where posewright cannot be built: setup_says.py SOURCE.

The system's own tools are replaced by scripts in a folder that stands first in the path."""
import os
import pathlib
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
WHEEL = "without compiling: pip install posewright-*.whl (docs/install.md)"


def setup(release=None, **tools):
    """(exit status, lines) of `scripts/setup build` on a system of that os-release whose tools do what the shell lines say."""
    with tempfile.TemporaryDirectory() as folder:
        called = pathlib.Path(folder, "called")
        for name, does in {"dpkg-query": "exit 1", "dpkg": ":", "apt-get": ":", "id": "echo 0", **tools}.items():
            tool = pathlib.Path(folder, name.replace("_", "-"))
            tool.write_text(f'#!/bin/sh\necho "${{0##*/}} $*" >>{called}\n{does}\n')
            tool.chmod(0o755)
        system = pathlib.Path(folder, "os-release")
        if release is not None:
            system.write_text(release)
        done = subprocess.run([source / "scripts/setup", "build"], capture_output=True, text=True,
                              env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "OS_RELEASE": str(system)})
        calls = [line for line in called.read_text().splitlines() if line.split()[0] in ("apt-get", "dpkg")] if called.exists() else []
        return done.returncode, done.stderr.strip(), calls


DEBIAN = 'PRETTY_NAME="Debian GNU/Linux 12 (bookworm)"\nVERSION_CODENAME=bookworm\n'
for release, name in (('PRETTY_NAME="Debian GNU/Linux 11 (bullseye)"\nVERSION_CODENAME=bullseye\n', "Debian GNU/Linux 11 (bullseye)"),
                      ("PRETTY_NAME='Ubuntu 22.04.5 LTS'\nUBUNTU_CODENAME=jammy\n", "'Ubuntu 22.04.5 LTS'"), (None, "this system")):
    status, error, calls = setup(release)
    assert status == 1 and not calls, (name, status, calls)
    assert error == f"posewright is built from source on Debian 12, Debian 13 and Ubuntu 24.04, not on {name}; {WHEEL}", error

for release in (DEBIAN, "VERSION_CODENAME=trixie\n", 'VERSION_CODENAME="wilma"\nUBUNTU_CODENAME=noble\n', "DEBIAN_CODENAME=trixie\n"):
    status, error, calls = setup(release)
    assert status == 0 and any(" install " in call for call in calls), (release, status, error)
assert not any("--configure" in call for call in calls), calls

status, error, _ = setup(DEBIAN, apt_get="exit 100")
assert status == 1 and "out of reach" in error and "pip install posewright-*.whl" in error, error

_, _, calls = setup(DEBIAN, dpkg='[ "$1" != --audit ] || echo "libfcl-dev is half installed"')
assert calls.index("dpkg --configure -a") < next(n for n, call in enumerate(calls) if " install " in call), calls

for compiler, version, accepted in (("GNU", "11.4.0", False), ("Clang", "13.0.1", False), ("GNU", "12.2.0", True), ("Clang", "14.0.6", True)):
    done = subprocess.run(["cmake", f"-DCMAKE_CXX_COMPILER_ID={compiler}", f"-DCMAKE_CXX_COMPILER_VERSION={version}", "-P",
                           source / "cmake/compiler_age.cmake"], capture_output=True, text=True)
    said = " ".join(done.stderr.split())
    assert (done.returncode == 0) == accepted, said
    assert accepted or f"by g++ 12 or clang 14 or later, not by {compiler} {version}; {WHEEL}" in said, said
