"""Gives every result what a notebook shows of it: `_repr_html_`, which Jupyter and its relatives call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import _core, _display_data, _display_plan

_SHOWN: dict[type, Callable[[Any], str]] = {
    _core.Plan: _display_plan.plan,
    _core.Evaluation: _display_plan.evaluation,
    _core.Observation: _display_plan.observation,
    _core.Route: _display_plan.route,
    _core.BlockEvaluation: _display_plan.block_evaluation,
    _core.Blocks: _display_plan.blocks,
    _core.Calibration: _display_data.calibration,
    _core.Simulation: _display_data.simulation,
    _core.Comparison: _display_data.comparison,
    _core.Compensation: _display_data.compensation,
    _core.NextPoses: _display_data.next_poses,
    _core.Stations: _display_data.stations,
    _core.Exported: _display_data.exported,
    _core.Report: _display_data.report,
}


def _method(show: Callable[[Any], str]) -> Callable[[Any], str]:
    def _repr_html_(self: Any) -> str:
        return show(self)

    _repr_html_.__doc__ = "What a notebook shows."
    return _repr_html_


def install() -> None:
    for result, show in _SHOWN.items():
        setattr(result, "_repr_html_", _method(show))
