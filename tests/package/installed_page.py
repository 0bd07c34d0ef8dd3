"""`init --show` of an installation takes the page that plans out of it: installed_page.py SOURCE BUILD. Where scripts/wasm was not run
there is no page to install."""
import pathlib
import subprocess
import sys
import tempfile

source, build = map(pathlib.Path, sys.argv[1:])
page = source / "build/wasm-package/posewright.html"
if not page.exists():
    print(f"Skipped: there is no {page.name} (scripts/wasm build/wasm-package makes it)")
    sys.exit(77)

with tempfile.TemporaryDirectory() as temporary:
    prefix, work = (pathlib.Path(temporary).resolve() / name for name in ("prefix", "work"))
    subprocess.run(["cmake", "--install", build, "--component", "program", "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
    installed = prefix / "share/posewright/posewright.html"
    assert installed.read_bytes() == page.read_bytes()
    work.mkdir()
    (work / "kr270.urdf").write_bytes((source / "examples/kr270/kr270.urdf").read_bytes())
    done = subprocess.run([prefix / "bin/posewright", "init", "kr270.urdf", "--tracker", "--yes", "--show"], cwd=work, env={"PATH": "/usr/bin:/bin"},
                          capture_output=True, text=True)
    assert done.returncode == 0 and str(work / "problem.html") in done.stdout, done
    text, own = (work / "problem.html").read_text(), page.read_text()
    begin, end = own.split("@GIVEN_PROJECT@")
    assert text.startswith(begin) and text.endswith(end), "the page with the problem is not the installed one"
    assert "kr270.urdf" in text[len(begin):-len(end)]
