"""colcon builds and tests a workspace with posewright, a C++ program that uses it and the measuring node:
colcon.py SOURCE SCRATCH. The workspace is built from its sources; ccache, which has compiled the same for the build folder of
these tests, makes that a matter of seconds, so the test skips where there is none."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

source, scratch = map(pathlib.Path, sys.argv[1:])
for program, package in (("colcon", "colcon python3-colcon-cmake python3-colcon-ros"), ("ccache", "ccache"), ("ninja", "ninja-build")):
    if shutil.which(program) is None:
        print(f"Skipped: {program} is missing (Debian: {package}; scripts/setup test installs it)")
        sys.exit(77)
shutil.rmtree(scratch, ignore_errors=True)

# Sources as links, so that this machine's build folders are not part of them. ccache takes paths relative to the source and to the
# folder it compiles in, so the workspace's build folder lies below the source as deep as those of the presets.
package = scratch / "src/posewright"
package.mkdir(parents=True)
listed = subprocess.run(["git", "-C", source, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True)
tops = {line.split("/")[0] for line in listed.stdout.splitlines()} or {entry.name for entry in source.iterdir()} - {"build"}
for name in tops:
    (package / name).symlink_to(source / name)
for name in ("posewright_consumer", "posewright_measure"):
    shutil.copytree(source / "examples/ros2" / name, scratch / "src" / name, ignore=shutil.ignore_patterns("__pycache__"))

# The machine's own Python, and the variables of no other workspace.
clean = {key: value for key, value in os.environ.items() if "PREFIX_PATH" not in key and key not in ("PYTHONPATH", "COLCON_DEFAULTS_FILE")}
clean |= {"PATH": "/usr/bin:/bin", "COLCON_LOG_PATH": str(scratch / "log"), "COLCON_HOME": str(scratch / "home")}
places = ["--build-base", package / "build", "--install-base", scratch / "install"]


def colcon(*words):
    done = subprocess.run(["/usr/bin/python3", "/usr/bin/colcon", *map(str, words)], cwd=scratch, env=clean, capture_output=True, text=True)
    print(done.stdout, flush=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


# Consumers of the examples folder are linked below the source too: only these three are built.
paths = ["--paths", package, scratch / "src/posewright_consumer", scratch / "src/posewright_measure"]
said = colcon("build", *paths, *places, "--event-handlers", "console_cohesion-", "--cmake-args", "-G", "Ninja")
assert "Summary: 3 packages finished" in said, said
said = colcon("test", *paths, *places, "--event-handlers", "console_cohesion-", "--return-code-on-test-failure", "--packages-select", "posewright", "posewright_consumer")
assert "Summary: 2 packages finished" in said, said
said = colcon("test-result", "--test-result-base", package / "build", "--all")
assert re.search(r"Summary: 4 tests, 0 errors, 0 failures, 0 skipped", said), said

# What ROS 2 looks for.
prefix = scratch / "install/posewright"
assert (prefix / "share/ament_index/resource_index/packages/posewright").is_file()
described = xml.parse(prefix / "share/posewright/package.xml").getroot()
version = re.search(r"project\(posewright VERSION (\S+)", (source / "CMakeLists.txt").read_text()).group(1)
assert (described.get("format"), described.findtext("name"), described.findtext("version")) == ("3", "posewright", version)
assert described.findtext("export/build_type") == "cmake"

# What a user has who sources the workspace: program, Python package, consumer, node.
script = (f". {scratch}/install/setup.sh && posewright --version | head -n 1 && python3 -c 'import posewright as pw; print(pw.__file__)' && "
          f"{scratch}/install/posewright_consumer/lib/posewright_consumer/consumer && echo && "
          f"test -x {scratch}/install/posewright_measure/lib/posewright_measure/measure && python3 -c 'import posewright_measure.stops as s; print(s.__file__)'")
done = subprocess.run(["sh", "-c", script], cwd=scratch, env=clean, capture_output=True, text=True)
assert done.returncode == 0, done.stdout + done.stderr
lines = done.stdout.splitlines()
assert lines[0] == f"posewright {version}" and lines[1].startswith(str(prefix)) and lines[2] == "-1 0 1 " and str(scratch / "install") in lines[3], lines
shutil.rmtree(scratch)
