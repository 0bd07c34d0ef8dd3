"""Programs and modules that take none of musl's functions from the system: own_mathematics.py OBJECTS FILE…; OBJECTS is the folder
with what cmake/mathematics.cmake took of musl's libc.a."""
import pathlib
import subprocess
import sys

objects, *files = sys.argv[1:]
own = {path.stem for path in pathlib.Path(objects).glob("*.o")}
assert {"sin", "cos", "atan2"} <= own, own
for file in files:
    symbols = subprocess.run(["nm", "-D", "--undefined-only", file], capture_output=True, text=True, check=True).stdout
    asked = {line.split()[-1].split("@")[0] for line in symbols.splitlines()}
    assert "strlen" in asked, f"{file} asks the system for nothing: {sorted(asked)[:9]}"
    assert not own & asked, f"{file} takes {sorted(own & asked)} from the system"
