"""README's two commands in one clone: what scripts/plan-telescope has compiled, scripts/test calls the compiler for in the same way,
so that nothing is compiled again: compiled_once.py SOURCE SCRATCH.

Configured as each script does it, first as on a machine without the tests' packages; nothing is compiled here."""
import pathlib
import re
import shutil
import sys

from debian import run

source, scratch = map(pathlib.Path, sys.argv[1:])
shutil.rmtree(scratch, ignore_errors=True)
NOT_YET = ("GTest", "MPI", "Python3", "pybind11", "Ceres")


def configure(script, *more):
    # Of scripts/test the last: the first configures for the quick tests alone.
    *_, words = re.findall(r"cmake --preset release( -D[^>\n]*)", (source / "scripts" / script).read_text())
    run("cmake", "--preset", "release", *words.split(), *more, "-S", source, "-B", scratch, cwd=source)
    calls = [line for line in run("ninja", "-C", scratch, "-t", "commands", "posewright_program").splitlines() if " -c " in line]
    return calls, {path: path.read_bytes() for path in scratch.rglob("cmake_pch.hxx") if "parsed_tests" not in str(path)}


first, headers = configure("plan-telescope", *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in NOT_YET))
assert len(first) > 40 and len(headers) > 1, (len(first), len(headers))
second, headers_then = configure("test", *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=OFF" for name in NOT_YET))
assert second == first, "\n".join(sorted(set(second) ^ set(first)))
assert headers_then == headers, sorted(map(str, headers_then))
# Everything that is tested is built, though the first command was configured without tests.
said = run("ninja", "-C", scratch, "-t", "targets", "all")
for target in ("posewright_mpi", "posewright_python", "test_support"):
    assert re.search(rf"(^|/){target}[:.]", said, re.M), f"{target} is not built"
shutil.rmtree(scratch)
