"""A mapping as the text of a problem file, every entry on a line of its own, so that a line tells the key."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from typing import Any


def problem_text(problem: Mapping[str, Any]) -> tuple[str, list[str]]:
    """Text (JSON, which is YAML) and the key path of each of its lines.

    Values may be what numpy and pathlib make; TypeError names the key of anything else.
    """
    if not isinstance(problem, Mapping):
        raise TypeError(f"a problem is a file's name or a mapping, not {type(problem).__name__}")
    lines = list(_lines(problem, "", "", ""))
    return "\n".join(text for text, _ in lines) + "\n", [place for _, place in lines]


def _lines(value: Any, place: str, head: str, tail: str) -> Iterator[tuple[str, str]]:
    if hasattr(value, "tolist"):  # arrays and numbers of numpy
        value = value.tolist()
    if isinstance(value, Mapping):
        yield head + "{", place
        for i, (key, entry) in enumerate(value.items()):
            if not isinstance(key, (str, int, float)):
                raise TypeError(f"{place or 'the problem'}: the key {key!r} is not text")
            inner = f"{place}.{key}" if place else str(key)
            yield from _lines(entry, inner, _scalar(str(key), inner) + ": ", "," if i + 1 < len(value) else "")
        yield "}" + tail, place
    elif isinstance(value, (list, tuple)):
        yield head + "[", place
        for i, entry in enumerate(value):
            yield from _lines(entry, f"{place}[{i}]", "", "," if i + 1 < len(value) else "")
        yield "]" + tail, place
    else:
        yield head + _scalar(value, place) + tail, place


def _scalar(value: Any, place: str) -> str:
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return json.dumps(value, ensure_ascii=False)
    raise TypeError(f"{place or 'the problem'} is a {type(value).__name__}; numbers, texts, lists and mappings are allowed")
