"""The shared libraries that a package needs are put into its wheel, as auditwheel does (which Debian 12 does not have).

Each gets a name with its hash, so that no other wheel's library of that name is taken for it, and finds the others beside it.
Tools: ldd, readelf (binutils), patchelf; dpkg says whose each library is, for its licence."""
from __future__ import annotations

import hashlib
import pathlib
import re
import shutil
import subprocess

# Present on every Linux that runs wheels (PEP 600).
EVERYWHERE = re.compile(r"(linux-vdso|ld-linux.*|lib(c|m|dl|rt|util|pthread|resolv|stdc\+\+|gcc_s))\.so.*")


def bundle(content: pathlib.Path, name: str) -> tuple[str, dict[str, str]]:
    """Libraries go to NAME.libs below `content`. Returns the platform's tag and {Debian packages: their copyright}."""
    if shutil.which("patchelf") is None:
        raise SystemExit("patchelf is missing (Debian: patchelf)")
    folder = content / f"{name}.libs"
    folder.mkdir()
    modules = [path for path in content.rglob("*.so") if folder not in path.parents]
    needed = {soname: path for module in modules for soname, path in _libraries(module).items()}
    names, licences = {}, {}
    for soname, path in sorted(needed.items()):
        stem, _, rest = soname.partition(".so")
        names[soname] = f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"
        shutil.copyfile(path, folder / names[soname])
        (folder / names[soname]).chmod(0o755)
        package = _package(path)
        licences[package] = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text()
    for soname, changed in names.items():
        _patch(folder / changed, names, "$ORIGIN", "--set-soname", changed)
    for module in modules:
        up = "/".join([".."] * len(module.relative_to(content).parent.parts))
        _patch(module, names, f"$ORIGIN/{up}/{folder.name}")
    return _platform([*modules, *folder.iterdir()]), _each_once(licences)


def _each_once(texts: dict[str, str]) -> dict[str, str]:
    """Libraries of one source share one text: {its names: text}."""
    names: dict[str, list[str]] = {}
    for name, text in sorted(texts.items()):
        names.setdefault(text, []).append(name)
    return {"+".join(shared): text for text, shared in names.items()}


def _libraries(module: pathlib.Path) -> dict[str, pathlib.Path]:
    """{soname: file} of all that the loader would bring, without what is everywhere."""
    found = {}
    for line in _output("ldd", module).splitlines():
        soname, arrow, rest = line.strip().partition(" => ")
        if not arrow or EVERYWHERE.fullmatch(soname):
            continue
        if rest.startswith("not found"):
            raise SystemExit(f"{module.name} needs {soname}, which is not installed")
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


def _platform(files: list[pathlib.Path]) -> str:
    """manylinux_2_N of the youngest symbol of glibc that any of them needs."""
    versions = {tuple(map(int, found)) for file in files for found in re.findall(r"\bGLIBC_(\d+)\.(\d+)", _output("readelf", "-VW", file))}
    major, minor = max(versions)
    machine = _output("uname", "-m").strip()
    return f"manylinux_{major}_{minor}_{machine}"


def _output(*words) -> str:
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout
