"""A folder of files as a wheel (PEP 427): metadata, record of hashes, archive. Same content, same bytes."""
from __future__ import annotations

import base64
import hashlib
import pathlib
import zipfile


def write(content: pathlib.Path, folder: pathlib.Path, project: dict, root: pathlib.Path, tag: str, licences: dict[str, str]) -> str:
    """Writes NAME-VERSION-TAG.whl into folder and returns its name; `licences` are texts of bundled libraries by name."""
    stem = f"{project['name'].replace('-', '_')}-{project['version']}"
    about = f"{stem}.dist-info"
    files = {str(path.relative_to(content)): (path.read_bytes(), path.stat().st_mode & 0o111)
             for path in sorted(content.rglob("*")) if path.is_file()}
    files[f"{about}/METADATA"] = (_metadata(project, root).encode(), 0)
    files[f"{about}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: posewright\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(), 0)
    if project.get("scripts"):
        lines = "".join(f"{name} = {place}\n" for name, place in project["scripts"].items())
        files[f"{about}/entry_points.txt"] = (f"[console_scripts]\n{lines}".encode(), 0)
    files[f"{about}/LICENSE"] = ((root / project["license"]["file"]).read_bytes(), 0)
    for name, text in sorted(licences.items()):
        files[f"{about}/licenses/{name}.txt"] = (text.encode(), 0)
    record = "".join(f"{name},sha256={_digest(data)},{len(data)}\n" for name, (data, _) in files.items())
    files[f"{about}/RECORD"] = ((record + f"{about}/RECORD,,\n").encode(), 0)
    with zipfile.ZipFile(folder / f"{stem}-{tag}.whl", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, (data, executable) in files.items():
            entry = zipfile.ZipInfo(name)  # 1980, so that the archive tells nothing of its day
            entry.external_attr = (0o100755 if executable else 0o100644) << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
    return f"{stem}-{tag}.whl"


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def _metadata(project: dict, root: pathlib.Path) -> str:
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}", "License: BSD-3-Clause",
             "License-File: LICENSE"]
    lines += [f"Classifier: {line}" for line in project["classifiers"]]
    lines += [f"Requires-Dist: {line}" for line in project["dependencies"]]
    lines += ["Description-Content-Type: text/markdown", "", (root / project["readme"]).read_text()]
    return "\n".join(lines)
