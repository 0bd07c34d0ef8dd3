"""Tables, lists and frames of what a notebook shows of a result. All of it is well-formed, and nothing is fetched."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence

_STYLE = (
    ".posewright table{border-collapse:collapse;margin:.5em 0}"
    ".posewright td,.posewright th{padding:.15em .7em;text-align:left!important;border-bottom:1px solid #8884}"
    ".posewright td.number,.posewright th.number{text-align:right!important;font-variant-numeric:tabular-nums}"
    ".posewright svg{max-width:100%;height:auto}"
    ".posewright iframe{width:100%;height:80vh;border:1px solid #8884}"
)


def text(value: object) -> str:
    """What is shown of a value; None is a dash."""
    return "–" if value is None else html.escape(str(value))


def table(header: Sequence[str], rows: Iterable[Sequence[object]], numbers: str = "") -> str:
    """`numbers` has an n for each column of numbers, anything else for one of words."""
    kinds = ["number" if letter == "n" else "word" for letter in numbers.ljust(len(header))]

    def row(cells: Sequence[object], tag: str) -> str:
        return "<tr>" + "".join(f'<{tag} class="{kind}">{text(cell)}</{tag}>' for cell, kind in zip(cells, kinds)) + "</tr>"

    body = "".join(row(cells, "td") for cells in rows)
    return f"<table><thead>{row(header, 'th')}</thead><tbody>{body}</tbody></table>"


def listed(lines: Iterable[str]) -> str:
    """A list, or nothing if there are no lines."""
    items = "".join(f"<li>{text(line)}</li>" for line in lines)
    return f"<ul>{items}</ul>" if items else ""


def folded(summary: str, content: str) -> str:
    return f"<details><summary>{text(summary)}</summary>{content}</details>"


def frame(page: str, title: str) -> str:
    """A whole page inside the notebook: it may run its scripts, but sees nothing of the notebook."""
    return f'<iframe title="{text(title)}" sandbox="allow-scripts allow-downloads" srcdoc="{html.escape(page, quote=True)}"></iframe>'


def shown(headline: str, *parts: str) -> str:
    """What `_repr_html_` returns: one sentence, then tables and figures."""
    return f'<div class="posewright"><style>{_STYLE}</style><p><b>{text(headline)}</b></p>{"".join(parts)}</div>'
