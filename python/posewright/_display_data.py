"""What a notebook shows of calibrations, virtual experiments, comparisons, compensated poses, stations, files and pages."""

from __future__ import annotations

from typing import Any

from ._core import Calibration, Comparison, Compensation, Exported, NextPoses, Report, Simulation, Stations, _shown
from ._display_plan import percent
from ._figures import bars, columns
from ._markup import folded, frame, listed, shown, table


def calibration(result: Calibration) -> str:
    json = result.to_dict()
    rows = [(p["name"], _shown(p["nominal"], p["unit"]), _shown(p["value"], p["unit"]), _shown(p["sigma"], p["unit"]) if p["sigma"] is not None else None,
             _interval(p), "" if p["estimated"] else p["why_not"] or "not estimated") for p in json["parameters"] if p["value"] is not None]
    axes = [(a["poses"], a["axis"], _shown(a["before"]["rms"], a["unit"]), _shown(a["after"]["rms"], a["unit"]),
             _shown(a["after"]["largest"], a["unit"])) for a in json["axes"] if a["before"] and a["after"]]
    histogram = json["histogram"]
    bins = [(f"{histogram['from'] + i * histogram['bin_width']:g}", count) for i, count in enumerate(histogram["counts"])] if histogram else []
    moved = [(p["name"], abs(p["value"] - p["nominal"]) / p["tolerance"]) for p in json["parameters"]
             if p["role"] == "interest" and p["value"] is not None and p["tolerance"]]
    return shown(
        f"{json['poses_fitted']} poses fitted, {json['poses_held_back']} held back: χ² {json['chi_square']:.1f} for {json['freedom']} degrees of freedom"
        + ("" if json["converged"] else ", not converged"),
        listed(json["notes"]),
        table(("poses", "axis", "RMS before", "RMS after", "largest after"), axes, "  nnn"),
        columns("weighted residuals, in σ", bins),
        bars("change of each parameter in tolerances", moved, logarithmic=True, mark=1.0),
        folded(f"{len(rows)} parameters", table(("parameter", "nominal", "value", "σ", "95 % interval", ""), rows, " nnnn ")))


def _interval(p: dict[str, Any]) -> str | None:
    """Of one parameter, and by what it is if it is not the usual one."""
    if p["interval"] is None:
        return None
    ends = ["no end" if end is None else _shown(end, p["unit"]) for end in p["interval"]]
    return " to ".join(ends) + (" (profile)" if p["interval_by"] == "profile" else "")


def simulation(result: Simulation) -> str:
    json = result.to_dict()
    ratios = [(p["name"], p["sigma_observed"] / p["sigma_predicted"]) for p in json["parameters"] if p["sigma_predicted"] and p["sigma_observed"] is not None]
    rows = [(p["name"], _shown(p["sigma_predicted"], p["unit"]) if p["sigma_predicted"] is not None else None,
             _shown(p["sigma_observed"], p["unit"]) if p["sigma_observed"] is not None else None, percent(p["coverage"]),
             percent(p["profile_coverage"])) for p in json["parameters"]]
    return shown(
        f"{json['draws']['fitted']} of {json['draws']['asked']} calibrations of {json['poses']} poses: the prediction "
        + ("holds" if json["confirmed"] else "is not confirmed"),
        listed(json["verdict"]),
        bars("σ observed by σ predicted", ratios, mark=1.0),
        folded(f"{len(rows)} parameters", table(("parameter", "σ predicted", "σ observed", "in the 95 % interval", "by profile"), rows, " nnnn")))


def next_poses(result: NextPoses) -> str:
    json = result.to_dict()
    curve = [point for point in json["curve"] if point["expected"] is not None]
    rows = [(point["poses"], _shown(point["expected"], "m"), None if point["upper"] is None else _shown(point["upper"], "m")) for point in curve]
    return shown(
        result.reason,
        listed(result.notes),
        columns("predicted error at the places over the number of poses, mm", [(str(point["poses"]), 1e3 * point["expected"]) for point in curve]),
        folded(f"{len(rows)} numbers of poses", table(("poses", "predicted error", "below with 95 % confidence"), rows, "nnn")))


def comparison(result: Comparison) -> str:
    json = result.to_dict()
    rows = [(s["plan"], s["variant"], percent(s["efficiency"]), None if s["log_det"] is None else f"{s['log_det']:.4f}",
             s["why_not"] or s["infeasible_because"] or "") for s in json["scores"]]
    return shown(
        f"{len(json['plans'])} plans for {len(json['variants'])} variants",
        listed(result.notes),
        table(("plan", "variant", "at least of the best", "log det", ""), rows, "  nn "),
        bars("efficiency", [(f"{s['plan']}, {s['variant']}", s["efficiency"]) for s in json["scores"]]),
        listed(w["text"] for w in json["worth"] if w["text"]))


def compensation(result: Compensation) -> str:
    json = result.to_dict()
    error, names = json["error"], ("position_rms", "position_largest", "rotation_rms", "rotation_largest")
    units = ("m", "m", "rad", "rad")
    rows = [(when, *(None if error[when][name] is None else _shown(error[when][name], unit) for name, unit in zip(names, units)))
            for when in ("before", "after") if error[when]]
    changes = [(c["name"], _shown(c["rms"], c["unit"]), _shown(c["largest"], c["unit"])) for c in json["changes"]]
    poses = [pose for part in json["lists"] for pose in part["poses"]]
    return shown(
        f"{json['compensated']} of {json['poses']} poses compensated",
        listed([*json["notes"], *result.failures]),
        table(("", "position RMS", "largest", "rotation RMS", "largest"), rows, " nnnn"),
        table(("joint", "change RMS", "largest"), changes, " nn"),
        columns("position error before, m", [(str(p["id"]), p["before"]["position"]) for p in poses if p["before"]][:200]))


def stations(result: Stations) -> str:
    ranking = result.to_dict()["ranking"]

    def named(entry: dict) -> str:  # type: ignore[type-arg]
        return ", ".join(f"{name} ({', '.join(f'{1e3 * x:.0f}' for x in place['position'])} mm)" for name, place in entry["stations"].items())

    planned = [r for r in ranking if "why_not" not in r]
    rows = [(i, named(r), f"{r['sigma_ratio']:.3f}" if r["sigma_ratio"] is not None else None, percent(r["feasible_share"]), r["main_rejection"])
            for i, r in enumerate(planned, 1)]
    return shown(
        f"{len(ranking)} places for the instrument, the best first",
        bars("σ by σ of the best", [(", ".join(r["stations"]), r["sigma_ratio"]) for r in planned], mark=1.0),
        listed([f"{', '.join(r['stations'])}: {r['why_not']}" for r in ranking if "why_not" in r]),
        table(("", "where", "σ by σ of the best", "poses possible", "most others fail by"), rows, "n nn "))


def exported(result: Exported) -> str:
    rows = [(name, f"{len(content)} bytes") for name, content in result.files.items()]
    return shown(f"{len(rows)} files", listed(result.notes), table(("file", "size"), rows, " n"))


def report(result: Report) -> str:
    return shown("Report", listed(result.notes), frame(result.to_html(), "report of posewright"))
