"""Wheels and archive that bring the libraries they need: wheels.py FOLDER BUILD writes into FOLDER, from a build folder of CMake,

  posewright-VERSION-py3-none-manylinux_….whl         the program, for any Python
  posewright-VERSION-linux-MACHINE.tar.gz             the same tree: unpack it, run bin/posewright
  posewright_python-VERSION-cp3N-cp3N-manylinux_….whl the Python package of one interpreter, on the program's libraries (if the folder
                                                      has it)"""
from __future__ import annotations

import gzip
import pathlib
import platform
import re
import shutil
import sys
import tarfile
import tempfile

import backend
import project
import repair
import wheel_file

# The program's wheel has its tree here, below site-packages.
PLACE = "posewright_program"


def program_tree(build: pathlib.Path, module: pathlib.Path | None, tree: pathlib.Path) -> tuple[str, dict[str, str]]:
    """bin, lib, libexec and share in `tree`; `module` is made to find lib too. Returns wheels' platform and licences."""
    backend.run("cmake", "--install", build, "--component", "program", "--prefix", tree, "--strip")
    program = tree / "libexec" / "posewright"
    program.parent.mkdir()
    (tree / "bin" / "posewright").rename(program)
    files = [program] if module is None else [program, module]
    licences = repair.bundle(files, tree / "lib")
    major, minor = repair.oldest_glibc([*files, *(tree / "lib").iterdir()])
    launcher = (pathlib.Path(__file__).parent / "launcher.sh").read_text()
    launcher = launcher.replace("@MACHINE@", platform.machine()).replace("@GLIBC@", f"{major}.{minor}")
    (tree / "bin" / "posewright").write_text(launcher)
    (tree / "bin" / "posewright").chmod(0o755)
    return f"manylinux_{major}_{minor}_{platform.machine()}", licences


def write_archive(tree: pathlib.Path, folder: pathlib.Path, licences: dict[str, str]) -> None:
    """Same content, same bytes."""
    name = f"posewright-{project.program()['version']}-linux-{platform.machine()}"

    def plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        entry.uid = entry.gid = entry.mtime = 0
        entry.uname = entry.gname = "root"
        entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
        return entry

    with tempfile.TemporaryDirectory() as aside, open(folder / f"{name}.tar.gz", "wb") as file, gzip.GzipFile("", "wb", 9, file, 0) as packed, \
            tarfile.open(mode="w", fileobj=packed) as archive:
        texts = pathlib.Path(aside)
        for library, text in licences.items():
            (texts / f"{library}.txt").write_text(text)
        for path in sorted(tree.rglob("*")):
            archive.add(path, f"{name}/{path.relative_to(tree)}", recursive=False, filter=plain)
        for path in [project.ROOT / "LICENSE", *sorted(texts.iterdir())]:
            archive.add(path, f"{name}/{'' if path.parent == project.ROOT else 'licenses/'}{path.name}", filter=plain)


def main(folder: pathlib.Path, build: pathlib.Path) -> None:
    with tempfile.TemporaryDirectory() as name:
        program, bindings = pathlib.Path(name) / "program", pathlib.Path(name) / "bindings"
        tree, module = program / PLACE, None
        if "POSEWRIGHT_PYTHON_DIR" in (build / "CMakeCache.txt").read_text():
            bindings.mkdir()
            [module] = backend.install_bindings(build, bindings).glob("_core*.so")
        # The module lies beside the tree as it will in site-packages, so that its way to the libraries is the same.
        beside = None if module is None else program / "posewright" / module.name
        if module is not None and beside is not None:
            beside.parent.mkdir(parents=True)
            module.rename(beside)
        platform_tag, licences = program_tree(build, beside, tree)
        write_archive(tree, folder, licences)
        if module is not None and beside is not None:
            beside.rename(module)
            beside.parent.rmdir()
        shutil.copy(pathlib.Path(__file__).parent / "program.py", tree / "__init__.py")
        wheel_file.write(program, folder, project.program(), project.ROOT, f"py3-none-{platform_tag}", licences)
        if module is not None:
            about = project.bindings()
            about["dependencies"] = [f"posewright == {about['version']}", *about["dependencies"]]
            version = re.match(r"_core\.cpython-(\d+)", module.name)
            assert version is not None, module.name
            wheel_file.write(bindings, folder, about, project.ROOT, f"cp{version[1]}-cp{version[1]}-{platform_tag}", {})


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: wheels.py FOLDER BUILD")
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
