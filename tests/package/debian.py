"""What the tests of the Debian packages share: they skip where a tool is missing, and stop where a command fails."""
import shutil
import subprocess
import sys


def skip(why):
    print(f"Skipped: {why}")
    sys.exit(77)


def need(**packages):
    """need(lintian="lintian"): the programs with the Debian package that each comes with."""
    for program, package in packages.items():
        program = program.replace("_", "-")
        if shutil.which(program) is None:
            skip(f"{program} is missing (Debian: {package}; scripts/setup test installs it)")


def run(*words, **how):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **how)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stdout}{done.stderr}")
    return done.stdout


def packages(folder):
    """{package: its file} of a repository's folder."""
    found = {file.name.split("_")[0]: file for file in folder.glob("*.deb")}
    if not found:
        skip(f"{folder} holds no packages: what makes them was skipped")
    assert set(found) == {"posewright", "libposewright-dev", "python3-posewright", "posewright-mpi"}, f"packages: {sorted(found)}"
    return found
