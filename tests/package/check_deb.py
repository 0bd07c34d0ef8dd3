"""The Debian package is whole and its program runs where it is unpacked: check_deb.py CPACK BUILD_FOLDER."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

NEEDED = [
    "usr/bin/posewright", "usr/share/bash-completion/completions/posewright", "usr/share/zsh/site-functions/_posewright",
    "usr/share/man/man1/posewright.1.gz", "usr/share/posewright/schemas/problem.schema.json",
    "usr/share/posewright/schemas/plan.schema.json", "usr/share/posewright/examples/telescope/problem.yaml",
    "usr/share/posewright/examples/kr270/kr270.urdf", "usr/share/doc/posewright/copyright",
    "usr/share/doc/posewright/changelog.gz", "usr/share/doc/posewright/changelog.Debian.gz",
    "usr/share/doc/posewright/README.md", "usr/share/doc/posewright/report-licenses.txt", "usr/share/doc/posewright/docs/problem-file.md"]


def run(*words, cwd):
    done = subprocess.run([str(w) for w in words], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stdout}{done.stderr}")
    return done.stdout


def main(cpack, build):
    for program, package in (("dpkg-shlibdeps", "dpkg-dev"), ("file", "file")):
        if shutil.which(program) is None:
            print(f"skipped: {program} is missing (Debian: {package})")
            sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(cpack, "-G", "DEB", "-B", folder, cwd=build)
        [package] = folder.glob("posewright_*.deb")
        listed = run("dpkg-deb", "-c", package, cwd=folder)
        for path in NEEDED:
            assert f" ./{path}\n" in listed, f"{path} is not in the package"
        control = run("dpkg-deb", "-f", package, cwd=folder)
        for library in ("libc6", "libompl16", "libfcl0.7", "libnlopt0", "libyaml-cpp0.7"):
            assert re.search(rf"^Depends: .*\b{library} \(>= ", control, re.M), f"no dependency on {library}"
        run("dpkg-deb", "-x", package, folder / "root", cwd=folder)
        program = folder / "root/usr/bin/posewright"
        assert run(program, "--version", cwd=folder).startswith("posewright 0.")
        examples = folder / "root/usr/share/posewright/examples"
        run(program, "plan", examples / "delta/problem.yaml", "--candidates", 100, "--method", "greedy", cwd=folder)
        assert len((folder / "poses.csv").read_text().splitlines()) == 21
        schema = (examples / "delta/problem.yaml").read_text().split("\n")[0].split("$schema=")[1]
        assert (examples / "delta" / schema).resolve().is_file(), "the example's schema is not installed"


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
