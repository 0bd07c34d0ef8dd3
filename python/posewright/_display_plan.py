"""What a notebook shows of plans, lists of poses, routes and of what can be identified."""

from __future__ import annotations

from typing import Any

from ._core import BlockEvaluation, Blocks, Evaluation, Observation, Plan, Route, _shown
from ._figures import bars, columns
from ._markup import folded, listed, shown, table

Json = dict[str, Any]


def _value(value: float | None, unit: str) -> str | None:
    return None if value is None else _shown(value, unit)


def percent(share: float | None) -> str | None:
    """Rounded down: what is stated as reached must be."""
    return None if share is None else f"{int(1e4 * share) / 100:.2f} %"


def _note(parameter: Json) -> str:
    if not parameter.get("identifiable", True):
        return f"dropped: {parameter.get('dependency') or parameter.get('dropped_because') or 'looks like others'}"
    if parameter["role"] == "nuisance":
        return "nuisance"
    return "" if parameter.get("worth_identifying") in (True, None) else "not worth identifying"


def _parameters(parameters: list[Json]) -> str:
    rows = [(p["name"], _value(p.get("nominal"), p["unit"]), _value(p["tolerance"], p["unit"]), _value(p.get("sigma"), p["unit"]), _note(p))
            for p in parameters]
    return table(("parameter", "nominal", "tolerance", "σ after calibration", ""), rows, " nnn ")


def _sigmas(parameters: list[Json]) -> str:
    items = [(p["name"], p["sigma"] / p["tolerance"]) for p in parameters
             if p["role"] == "interest" and p.get("sigma") is not None and p["tolerance"]]
    return bars("σ in tolerances", items, logarithmic=True, mark=1.0)


def _poses(poses: list[Json]) -> str:
    if not poses:
        return ""
    names, units = poses[0].get("names", []), poses[0].get("units", [])  # none where blocks were chosen
    rows = [(p["id"], p.get("candidate"), *(_value(q, unit) for q, unit in zip(p.get("configuration", []), units)),
             p.get("station"), p.get("load_case"), percent(p.get("efficiency_without"))) for p in poses]
    return table(("pose", "candidate", *names, "station", "load case", "left without it"), rows, "nn" + "n" * len(names) + "  n")


def _of_plan(result: Any, json: Json) -> list[str]:
    return [
        table(("criterion", "value", "log det", *json["criterion"]["indices"]),
              [(json["criterion"]["name"], f"{json['criterion']['value']:.6g}", f"{json['criterion']['log_det']:.4f}",
                *(f"{value:.4g}" for value in json["criterion"]["indices"].values() if value is not None))], " nnnnnnn"),
        _sigmas(json["parameters"]),
        columns("share of the information of each pose", [(str(p["id"]), p["contribution"]) for p in json["poses"]]),
        folded(f"{len(json['parameters'])} parameters", _parameters(json["parameters"])),
        folded(f"{len(json['poses'])} poses", _poses(json["poses"])),
    ]


def plan(result: Plan) -> str:
    return shown(repr(result)[len("<Plan: "):-1], *_of_plan(result, result.to_dict()))


def evaluation(result: Evaluation) -> str:
    json = result.to_dict()
    scores = table(("criterion", "value", "at least of the best"),
                   [(s["criterion"], f"{s['value']:.6g}", percent(s["efficiency"])) for s in json["scores"]], " nn")
    changes = []
    if json.get("drop"):
        changes.append(f"without poses {', '.join(map(str, json['drop']['poses']))}: {percent(json['drop']['efficiency'])} of the list")
    if json.get("add"):
        changes.append(f"with {len(json['add']['poses'])} more: {percent(json['add']['efficiency'])} of the list")
    return shown(repr(result)[len("<Evaluation: "):-1], scores, listed(changes), *_of_plan(result, json))


def route(result: Route) -> str:
    json = result.to_dict()
    seconds = json["seconds"]
    rows = [(m["from"] or "home", m["to"] or "home", f"{m['seconds']:.2f} s", m["found_by"], m["nearest"] and _shown(m["nearest"]["distance"], "m"))
            for m in json["motions"]]
    return shown(
        f"{len(json['order'])} poses, {seconds['travel']:.1f} s of travel" + (", the shortest order of these motions" if seconds["optimal"] else ""),
        listed(f"pose {skipped['pose']} cannot be reached: {skipped['reason']}" for skipped in json["unreachable"]),
        columns("seconds of each motion", [(f"{m['from'] or 'home'} to {m['to'] or 'home'}", m["seconds"]) for m in json["motions"]]),
        folded(f"{len(rows)} motions", table(("from", "to", "time", "found by", "nearest bodies"), rows, "nnn n")))


def observation(result: Observation) -> str:
    json = result.to_dict()
    values = json["singular_values"]
    practical = {p["name"]: p for p in (json.get("practical") or {}).get("parameters", [])}
    rows = [{**p, **practical.get(p["name"], {})} for p in json["parameters"]]
    return shown(
        f"{json['variant']}: {json['rank']} of {len(rows)} parameters can be identified, from {json['smallest_poses'] or 'no number of'} poses",
        listed(d.equation for d in result.dependencies),
        bars("singular values", [(str(i), value) for i, value in enumerate(values, 1)], logarithmic=True),
        folded(f"{len(rows)} parameters", _parameters(rows)))


def block_evaluation(result: BlockEvaluation) -> str:
    indices = result.indices
    return shown(
        f"log det {result.log_det:.4f}, condition {result.condition:.4g}",
        table(tuple(indices), [tuple(f"{value:.4g}" for value in indices.values())], "nnnnn"),
        bars("singular values", [(str(i), float(value)) for i, value in enumerate(result.singular_values, 1)], logarithmic=True),
        bars("σ", [(str(i), float(value)) for i, value in enumerate(result.sigma, 1)], logarithmic=True))


def blocks(result: Blocks) -> str:
    n, r, m = result.shape
    rows = [(p.name, p.role, _shown(p.tolerance, p.unit)) for p in result.parameters]
    return shown(f"{n} blocks of {r} readings for {m} parameters", folded(f"{m} parameters", table(("parameter", "role", "tolerance"), rows, "  n")))
