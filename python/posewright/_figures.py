"""Figures as inline SVG: bars beside their names, and columns in a row. Each bar states its value in full as a tooltip."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ._markup import text

_FILL, _MARK = "#2f6f9f", "#c0392b"
_LABELS, _WIDTH, _ROW = 170, 420, 16  # px


def bars(title: str, items: Sequence[tuple[str, float | None]], *, logarithmic: bool = False, mark: float | None = None) -> str:
    """A bar for each item that has a positive value. `mark` is a value that a line is drawn at."""
    kept = [(label, value) for label, value in items if value is not None and math.isfinite(value) and value > 0]
    if not kept:
        return ""
    values = [value for _, value in kept] + ([mark] if mark else [])
    least = math.floor(math.log10(min(values)) - 0.1)  # a decade's begin, so that the smallest has a length
    most = max(values)

    def length(value: float) -> float:
        share = (math.log10(value) - least) / (math.log10(most) - least) if logarithmic else value / most
        return _WIDTH * share

    drawn = []
    for row, (label, value) in enumerate(kept):
        y = 22 + _ROW * row
        drawn.append(f'<text x="{_LABELS - 6}" y="{y + 11}" text-anchor="end">{text(label)}</text>')
        drawn.append(_rect(_LABELS, y, length(value), _ROW - 3, label, value))
    height = 26 + _ROW * len(kept)
    if mark:
        x = _LABELS + length(mark)
        drawn.append(f'<line x1="{x:.2f}" x2="{x:.2f}" y1="18" y2="{height - 4}" stroke="{_MARK}"><title>{mark!r}</title></line>')
    scale = f"logarithmic, from {10.0**least:g}" if logarithmic else f"to {most:.4g}"
    return _svg(f"{title} ({scale})", _LABELS + _WIDTH + 10, height, drawn)


def columns(title: str, items: Sequence[tuple[str, float]]) -> str:
    """A column for each item, in their order, from zero up."""
    most = max((value for _, value in items), default=0)
    if most <= 0:
        return ""
    step = max(6.0, min(24.0, 590 / len(items)))
    drawn = [_rect(5 + step * i, 24 + 100 * (1 - value / most), step - 1, 100 * value / most, label, value) for i, (label, value) in enumerate(items)]
    width = 10 + step * len(items)
    drawn.append(f'<text x="5" y="138">{text(items[0][0])}</text><text x="{width - 5:.2f}" y="138" text-anchor="end">{text(items[-1][0])}</text>')
    return _svg(f"{title} (to {most:.4g})", max(width, 300), 144, drawn)


def _rect(x: float, y: float, width: float, height: float, label: str, value: float) -> str:
    return (f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" fill="{_FILL}">'
            f"<title>{text(label)}: {value!r}</title></rect>")


def _svg(title: str, width: float, height: float, drawn: list[str]) -> str:
    return (f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.0f} {height:.0f}" '
            f'font-family="sans-serif" font-size="11" fill="currentColor"><title>{text(title)}</title>'
            f'<text x="5" y="13" font-weight="bold">{text(title)}</text>{"".join(drawn)}</svg>')
