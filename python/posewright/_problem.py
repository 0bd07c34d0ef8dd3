from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _core
from ._mapping import problem_text

Path = Union[str, "os.PathLike[str]"]


class Problem(_core.Problem):
    """Robot, instrument, variants and workspace: a problem file (docs/problem-file.md) or the same as a dictionary.

    source: the file's name, or a mapping with the keys of a problem file.
    base: folder that paths in a mapping are relative to (the current one); a file's paths are relative to the file.
    packages: {name: folder} for meshes named package://name/…
    """

    def __init__(
        self, source: Union[Path, Mapping[str, Any]], base: Optional[Path] = None, *, packages: Mapping[str, Path] = {}
    ) -> None:
        folders = {name: os.fspath(folder) for name, folder in packages.items()}
        if isinstance(source, Mapping):
            text, places = problem_text(source)
            super().__init__(text, os.path.join(os.fspath(base or ""), "problem"), places, folders)
        elif base is not None:
            raise TypeError("base belongs to a mapping; paths in a file are relative to the file")
        else:
            super().__init__(os.fspath(source), folders)

    @classmethod
    def from_text(
        cls, text: str, base: Optional[Path] = None, *, name: str = "problem", packages: Mapping[str, Path] = {}
    ) -> Problem:
        """The text of a problem file; messages call it by `name`."""
        problem = cls.__new__(cls)
        folders = {package: os.fspath(folder) for package, folder in packages.items()}
        _core.Problem.__init__(problem, text, os.path.join(os.fspath(base or ""), name), [], folders)
        return problem


def blocks(
    problem: _core.Problem, configurations: Any, variant: str = "", *, threads: int = 0
) -> _core.Blocks:
    """Whitened Jacobian blocks of configurations: a Plan, the name of a pose list, or an array N × n in SI units.

    Of a Plan the columns are exactly those it identifies. For many calls make a Model once and call its blocks().
    """
    if isinstance(configurations, _core.Plan):
        model = _core.Model(problem, configurations, variant, threads=threads)
    else:
        model = _core.Model(problem, variant, threads=threads)
    return model.blocks(configurations, threads=threads)
