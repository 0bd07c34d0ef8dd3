"""What `calibrate` states, against the same least squares by scipy and every statistic from its definition."""
import numpy as np
from scipy import stats

import calibration_judgement as judgement
import calibration_problems as drawn
from calibration_estimate import Estimate, calibrated, rms_by_kind
from statistics_by_definition import displaced
from visit_errors_by_definition import compare_visits, with_visits

# What may differ. Both sides solve equations; the program takes the covariance at the solution after two rounds, before noise and
# estimate settle, so the last thousandths of σ are its own. Everything but the last line is judged at the noise that it states.
ALLOWED = {"model / m": 1e-12, "tolerance": 1e-12, "rank": 0, "estimate / σ": 1e-2, "turned / σ": 1e-2, "σ": 1e-3, "interval": 1e-6,
           "covariance": 2e-3, "file / tolerance": 1e-9, "residual / RMS": 1e-2, "RMS": 1e-3, "placed RMS": 5e-3, "held-out RMS": 5e-3,
           "χ²": 1e-3, "freedom": 0, "p of χ²": 1e-3, "lack of fit": 1e-2, "within a pose": 1e-2, "serial": 1e-2, "normality": 1e-2,
           "spread": 1e-6, "left out": 1e-2, "decision": 0, "noise factor": 1e-2,
           "visits: −2 ln likelihood": 1e-2, "visits: chance": 3e-2, "visits: stated": 0}


MOST_DEPENDENT = 1e5  # Beyond that derivatives by differences say nothing of σ.


class Check:
    """Differences by what they are of; the largest of each."""

    def __init__(self):
        self.worst = {}

    def note(self, what, off):
        off = float(np.max(np.abs(off))) if np.size(off) else 0.0
        self.worst[what] = max(self.worst.get(what, 0.0), off if np.isfinite(off) else np.inf)

    def close(self, what, mine, stated):
        """Relative; both may say that there is nothing."""
        if mine is None or stated is None:
            return self.note(what, 0 if mine is None and stated is None else np.inf)
        mine, stated = np.asarray(mine, float), np.asarray(stated, float)
        self.note(what, np.abs(mine - stated) / np.maximum(np.maximum(np.abs(mine), np.abs(stated)), 1e-12))

    def test(self, what, mine, stated):
        """Statistic, in units of one or of itself if it is larger, and its chance."""
        if mine is None or stated is None:
            return self.note(what, 0 if mine is None and stated is None else np.inf)
        self.note(what, (mine[0] - stated["statistic"]) / max(1, abs(mine[0])))
        # A chance falls off as an exponential of the statistic does: as many times more sensitive as it has e-foldings.
        log = np.log(max(mine[1], 1e-300))
        self.note(what, (log - np.log(max(stated["probability"], 1e-300))) / max(1, -log))

    def wrong(self):
        return [f"{what} off by {off:.1e}" for what, off in self.worst.items() if off > ALLOWED[what]]


def estimated_names(run, check):
    """Whom the program estimates, whose tolerance counts; by the documentation: links and joints always, others if stated."""
    estimated = [p for p in run.result["parameters"] if p["estimated"]]
    counts = []
    for p in run.result["parameters"]:
        unit, stated = run.arm.tolerance(p["name"], run.variant)
        check.close("tolerance", unit, p["tolerance"])
        places = p["name"].split(".")[0] in ("base", "tool", "target", "station")
        should = "none" if "--no-prior" in run.way["options"] else "stated" if stated else "none" if places else "assumed"
        if p["estimated"]:
            check.note("tolerance", 0 if p["prior"] == should else np.inf)
            counts += [p["name"]] if should != "none" else []
        check.note("tolerance", 0 if p["tolerance_times"] >= 1 and (p["prior"] == "assumed" or p["tolerance_times"] == 1) else np.inf)
    return estimated, [p["name"] for p in estimated], counts


def compare_rank(run, estimate, check):
    """What is left at its nominal value is told from nothing: all columns together have the rank of those estimated."""
    left = [p["name"] for p in run.result["parameters"] if not p["estimated"]]
    everything = Estimate.__new__(Estimate)
    everything.__dict__ = estimate.__dict__ | {"names": estimate.names + left, "x": np.append(estimate.x, np.zeros(len(left))),
                                               "units": np.append(estimate.units, [run.arm.tolerance(n, run.variant)[0] for n in left]),
                                               "counted": np.append(estimate.counted, np.zeros(len(left), bool))}
    J = everything.columns_of_readings()
    J = J / np.maximum(np.linalg.norm(J, axis=0), 1e-300)
    rank = lambda A: int(np.sum(np.linalg.svd(A, compute_uv=False) > 1e-6))
    check.note("rank", rank(J) - rank(J[:, :len(estimate.names)]))


def compare_parameters(run, estimate, stated, check):
    result = run.result
    off = np.array([p["value"] - p["nominal"] for p in stated]) - estimate.x * estimate.units
    sigma = np.array([p["sigma"] for p in stated])
    plain = np.array([not (p["interval"] is None) for p in stated])
    check.note("estimate / σ", (off / estimate.sigma)[plain])
    check.close("σ", estimate.sigma[plain], sigma[plain])
    width = stats.t.ppf(0.975, result["freedom"]) if run.weights == "ols" else stats.norm.ppf(0.975)
    for p in stated:
        if p["interval"] is not None:
            # In units of σ: an end may stand at zero. Those by profile have linear ones beside them.
            ends = p["value"] + np.array([-1, 1]) * width * p["sigma"]
            check.note("interval", (ends - np.array(p["linear_interval"])) / p["sigma"])
    order = [estimate.names.index(name) for name in result["covariance"]["columns"]]
    kept = [k for k in range(len(order)) if plain[order[k]]]
    mine = estimate.covariance[np.ix_(order, order)][np.ix_(kept, kept)]
    size = np.sqrt(np.outer(np.diag(mine), np.diag(mine)))
    check.note("covariance", (mine - np.array(result["covariance"]["rows"])[np.ix_(kept, kept)]) / size)
    for o in result["orientations"]:
        R, C = estimate.turned(o["frame"])
        D = displaced([0, 0, 0, *o["rx_ry_rz"]])[:3, :3] @ R.T
        check.note("turned / σ", np.array([D[2, 1], D[0, 2], D[1, 0]]) / np.sqrt(np.diag(C)))
        size = np.sqrt(np.outer(np.diag(C), np.diag(C)))
        check.note("covariance", (C - np.array(o["covariance"])) / size)
        check.close("σ", width * np.sqrt(np.diag(C)), o["half_width"])


def compare_residuals(run, estimate, placed, check):
    result = run.result
    rows = [np.array([np.nan if v is None else v for v in p["residuals"]]) for p in result["poses"]]
    fitted = np.array([r for r, p in zip(rows, result["poses"]) if not p["held_back"]])
    check.note("residual / RMS", np.nan_to_num(fitted - estimate.residuals()) / rms_by_kind(estimate.residuals())["m"])
    tables = {(t["poses"], t["parameters"], t["kind"]): t["rms"] for t in result["residuals"]}
    nominal = estimate.z - run.arm.readings(estimate.poses, estimate.nominal)
    for name, residuals, what in (("nominal", nominal, "RMS"), ("placed", placed.residuals(), "placed RMS"),
                                  ("calibrated", estimate.residuals(), "RMS")):
        if name == "placed" and placed.names == estimate.names:
            continue
        for kind, rms in rms_by_kind(residuals).items():
            check.close(what, rms if np.isfinite(rms) else None, tables.get(("fitted", name, kind)))
    away = run.later
    if away is None and run.held.any():
        poses, z = drawn.averaged(run.arm, run.poses, [(i, line) for i, lines in enumerate(run.lines) for line in lines])
        away = (poses[run.held], z[run.held])
    if away is None:
        return
    for name, change in (("nominal", estimate.nominal), ("placed", placed.change(placed.x)), ("calibrated", estimate.change(estimate.x))):
        if name == "placed" and placed.names == estimate.names:
            continue
        for kind, rms in rms_by_kind(away[1] - run.arm.readings(away[0], change)).items():
            check.close("held-out RMS", rms if np.isfinite(rms) else None, tables.get(("held back", name, kind)))


def compare_tests(run, estimate, first, check):
    tests = run.result["tests"]
    whitened = np.where(estimate.read, estimate.whitened(), np.nan)
    # Few readings say nothing, and the program then says nothing.
    if tests["serial_correlation"]:
        check.test("serial", judgement.pose_by_pose(estimate) if run.weights == "wls" else judgement.serial_correlation(whitened), tests["serial_correlation"])
    if tests["normality"]:
        check.test("normality", judgement.jarque_bera(whitened[estimate.read]), tests["normality"])
    if tests["within_pose_correlation"]:
        check.test("within a pose", judgement.within_pose(estimate), tests["within_pose_correlation"])
    if run.repeated:
        check.test("lack of fit", judgement.lack_of_fit(estimate, run.lines, run.poses), tests["lack_of_fit"])
    check.close("freedom", estimate.freedom() + 1, run.result["freedom"] + 1)
    if run.weights == "wls":
        # Where the stated noise is refused, assumed tolerances count otherwise beside the noise that counts than beside that one.
        if run.result["noise_factor"] == 1 or all(p["tolerance_times"] == 1 for p in run.result["parameters"]):
            check.close("χ²", first.chi_square(), run.result["chi_square"])
        check.close("p of χ²", judgement.both_sides_of_chi_square(run.result["chi_square"], first.freedom()),
                    tests["chi_square"]["probability"])


def stated_noise(run, estimate):
    """What the program says that the noise is: a multiple of the stated covariance; ols: in m, of the mean stated variance."""
    if run.weights == "wls":
        return run.result["noise_factor"]
    if not estimate.counted.any():
        return estimate.noise_shown()
    stated = run.arm.covariances(estimate.poses, estimate.change(estimate.x))
    return run.result["noise_scale"] * np.sqrt(np.diagonal(stated, axis1=1, axis2=2)[estimate.read].mean())


def check_noise(run, first, estimate, check):
    """The noise is as stated unless chance refuses that; then (ols: always) what the residuals of the estimate with it show,
    but never less than stated. Few readings beside tolerances may agree with more than one noise."""
    shown, noise = estimate.noise_shown(), estimate.factor
    if run.weights == "wls":
        shown = max(1.0, shown) if first.refused() else 1.0
    check.close("noise factor", shown, noise)


def compare_rest(run, brute_force, estimate, placed, check):
    """The file that is written, whether one is; the scatter of lines; poses that are left out."""
    for p in run.result["parameters"] if run.file else []:
        # Parameters that are not in the file keep their nominal values.
        written = run.file.get(run.arm.own.get(p["name"], p["name"]), {"value": p["nominal"]})
        check.note("file / tolerance", (written["value"] - p["value"]) / p["tolerance"])
    if run.repeated:
        counts = [(~np.isnan(lines)).sum(axis=0) for lines in run.lines]
        deviations = [lines - np.nansum(lines, axis=0) / np.maximum(n, 1) for lines, n in zip(run.lines, counts)]
        number = sum(np.maximum(n - 1, 0) for n in counts)
        check.close("spread", np.sqrt(np.nansum(np.concatenate(deviations) ** 2, axis=0) / number), run.result["spread_within_pose"])
    said = run.result["left_out"]
    if not said["groups"]:
        return
    mine = said
    # The few readings that are left may agree with more than one noise where nobody states it and tolerances count.
    one_noise = run.weights == "wls" or not estimate.counted.any()
    if brute_force and one_noise and said["estimated"] is not None:
        try:
            mine = judgement.left_out(estimate, placed, run.weights)
        except np.linalg.LinAlgError:
            # Without one of the poses the others do not determine everything.
            pass
    if mine is not said:
        # Where both predict the same, the gain is rounding over rounding.
        alike = abs(mine["estimated"] / mine["placed"] - 1) < 1e-6
        for key, value in mine.items():
            check.close("left out", value, said[key] if key != "gain" or not alike else value)
    # Worse than base and tool alone beyond chance: nothing is written, exit status 1. No better: a word of its own.
    gains = mine["estimated"] is not None and mine["gain"] > 2
    worse = mine["estimated"] is None or not mine["gain"] >= -2
    refused = run.result["verdict"] == "do not use"
    check.note("decision", said["gains"] != gains or (worse and not refused) or (run.result["verdict"] == "use it" and not gains))
    check.note("decision", (run.status == 1) != refused or (run.file is None) != refused or refused != bool(run.result["refusals"]))


def compare(run, brute_force):
    """All that can be judged of a run; None where parameters are so nearly dependent that differences cannot tell."""
    check = Check()
    stated, names, counts = estimated_names(run, check)
    # How many times assumed tolerances count is the program's: the readings told it, all together.
    run.arm.times = {p["name"]: p["tolerance_times"] for p in stated}
    visits, stated_arm = run.result["visit_errors"], run.arm
    if visits:
        run.arm = with_visits(run.arm, visits)
    poses, z = run.fitted()
    check.note("model / m", run.arm.differs_from_arm(poses.Q[0], {n: v for n, v in run.truth.items() if not n.startswith("station")}))
    # From where the robot was drawn: base, tool and targets; everything else from its nominal value.
    start = {n: v for n, v in run.truth.items() if n.split(".")[0] in ("base", "target")}
    first = Estimate(run.arm, run.variant, names, poses, z, counts, run.weights, 1.0, start)
    if np.linalg.cond(first.J / np.linalg.norm(first.J, axis=0)) > MOST_DEPENDENT:
        return None
    estimate = first
    # In m where the robot is found to stand.
    for _ in range(1 if run.weights == "wls" else 3):
        noise = stated_noise(run, estimate)
        estimate = Estimate(run.arm, run.variant, names, poses, z, counts, run.weights, noise, start)
    check_noise(run, first, estimate, check)
    if visits:
        compare_visits(stated_arm, estimate, visits, check)
    roles = {p["name"]: p["role"] for p in stated}
    places = [n for n in names if n.split(".")[0] in ("base", "tool", "target", "station") or roles[n] == "nuisance"]
    # Noise and tolerances may agree at more than one noise: small, with the robot where the readings have it, or large, with the
    # robot near where it was meant to be. What fits best counts.
    begins = [None, estimate.noise_shown()] if run.weights == "ols" else [None]
    tried = [calibrated(run.arm, run.variant, places, poses, z, [n for n in counts if n in places], run.weights,
                        start if begin is None else estimate.differences(), begin)[0] for begin in begins]
    placed = min(tried, key=lambda fit: np.nansum(fit.residuals() ** 2))
    compare_rank(run, first, check)
    compare_parameters(run, estimate, stated, check)
    compare_residuals(run, estimate, placed, check)
    compare_tests(run, estimate, first, check)
    compare_rest(run, brute_force, estimate, placed, check)
    return check
