"""The shared libraries that programs and modules need are put beside them, as auditwheel does (which Debian 12 does not have).

Each gets a name with its hash, so that no other library of that name in the process is taken for it, and finds the others beside it.
Tools: ldd, readelf (binutils), patchelf; dpkg says whose each library is, for its licence."""
from __future__ import annotations

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

# Present on every Linux that runs wheels (PEP 600).
EVERYWHERE = re.compile(r"(linux-vdso|ld-linux.*|lib(c|m|dl|rt|util|pthread|resolv|stdc\+\+|gcc_s))\.so.*")
# Of the C++ library of GCC 12, which is as old as glibc 2.35.
YOUNGEST_CXX = (3, 4, 30)


def bundle(files: list[pathlib.Path], folder: pathlib.Path) -> dict[str, str]:
    """Copies all libraries that `files` need into `folder`, where they find them. Returns {Debian packages: their copyright}."""
    if shutil.which("patchelf") is None:
        raise SystemExit("patchelf is missing (Debian: patchelf)")
    folder.mkdir(parents=True)
    needed = {soname: path for file in files for soname, path in _libraries(file).items()}
    names, licences = {}, {}
    for soname, path in sorted(needed.items()):
        stem, _, rest = soname.partition(".so")
        names[soname] = f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"
        shutil.copyfile(path, folder / names[soname])
        (folder / names[soname]).chmod(0o755)
        package = _package(path)
        licences[package] = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text()
    for changed in names.values():
        _patch(folder / changed, names, "$ORIGIN", "--set-soname", changed)
    for file in files:
        _patch(file, names, f"$ORIGIN/{os.path.relpath(folder, file.parent)}")
    return _each_once(licences)


def oldest_glibc(files: list[pathlib.Path]) -> tuple[int, int]:
    """Version of the youngest symbol of glibc that any of them needs."""
    cxx = max((found for file in files for found in _symbols(file, "GLIBCXX")), default=())
    if cxx > YOUNGEST_CXX:
        raise SystemExit(f"a symbol of GLIBCXX_{'.'.join(map(str, cxx))} is needed: build on Debian 12, so that older systems can run it")
    major, minor = max(found[:2] for file in files for found in _symbols(file, "GLIBC"))
    return major, minor


def _symbols(file: pathlib.Path, library: str) -> set[tuple[int, ...]]:
    return {tuple(map(int, found.split("."))) for found in re.findall(rf"\b{library}_(\d+(?:\.\d+)+)", _output("readelf", "-VW", file))}


def _each_once(texts: dict[str, str]) -> dict[str, str]:
    """Libraries of one source share one text: {its names: text}."""
    names: dict[str, list[str]] = {}
    for name, text in sorted(texts.items()):
        names.setdefault(text, []).append(name)
    return {"+".join(shared): text for text, shared in names.items()}


def _libraries(file: pathlib.Path) -> dict[str, pathlib.Path]:
    """{soname: file} of all that the loader would bring, without what is everywhere."""
    found = {}
    for line in _output("ldd", file).splitlines():
        soname, arrow, rest = line.strip().partition(" => ")
        if not arrow or EVERYWHERE.fullmatch(soname):
            continue
        if rest.startswith("not found"):
            raise SystemExit(f"{file.name} needs {soname}, which is not installed")
        found[soname] = pathlib.Path(rest.rsplit(" (", 1)[0])
    return found


def _patch(file: pathlib.Path, names: dict[str, str], path: str, *more: str) -> None:
    # One change a call: patchelf 0.14 garbles files where it replaces names and sets the path at once.
    replaced = [word for old, new in names.items() if old in _needed(file) for word in ("--replace-needed", old, new)]
    for change in (replaced, more, ("--set-rpath", path)):
        if change:
            _output("patchelf", *change, file)


def _needed(file: pathlib.Path) -> list[str]:
    return _output("patchelf", "--print-needed", file).split()


def _package(library: pathlib.Path) -> str:
    """Debian package of a library. Where /lib is a link to /usr/lib, dpkg knows one of the two names."""
    real = library.resolve()
    for name in (real, pathlib.Path(str(real).removeprefix("/usr"))):
        done = subprocess.run(["dpkg-query", "-S", str(name)], capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout.split(":")[0]
    raise SystemExit(f"{library} belongs to no Debian package, so its licence is not known")


def _output(*words) -> str:
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout
