"""What plans and evaluations state of a list of poses, against the definitions, and bounds against every set of the list."""
import itertools

import numpy as np
from scipy import stats

from criteria_values import Design, Effects, Fitted

UNBOUNDED = ("o2", "bias")  # o2 because every problem here has nuisance columns
NOISE = 1e-7  # Of a potential.
CLOSE = 1e-6  # Relative; differences of two derivatives by differences, amplified by what is nearly dependent.


class Check:
    """What differs, and by how much at most."""

    def __init__(self):
        self.wrong, self.worst, self.checks = [], 0.0, 0

    def same(self, what, mine, stated, tolerance=CLOSE, floor=1e-12):
        """Relative, by the larger of both and at least `floor`; or both say that there is nothing."""
        self.checks += 1
        none = mine is None or not np.isfinite(mine)
        if none or stated is None:
            if not (none and stated is None):
                self.wrong.append(f"{what}: {mine} by definition, {stated} stated")
            return
        off = abs(mine - stated) / max(abs(mine), abs(stated), floor)
        self.worst = max(self.worst, off / tolerance * CLOSE)
        if off > tolerance:
            self.wrong.append(f"{what}: {mine:.10g} by definition, {stated:.10g} stated")

    def report(self, told, done):
        said = done.stderr.strip()[:120] if done.returncode else f"{self.checks} checks, {self.worst:.0e}"
        print(f"{told}: {said}{'  FAILED: ' + '; '.join(self.wrong[:4]) if self.wrong else ''}", flush=True)
        return not self.wrong

    def holds(self, what, true):
        self.checks += 1
        if not true:
            self.wrong.append(what)


class Definitions:
    """What a plan or evaluation of `arm` means, over a list of poses."""

    def __init__(self, arm, result, poses):
        self.arm, self.result, design = arm, result, arm.problem["design"]
        self.several = result.get("variants", [])
        variants = [v["name"] for v in self.several] or [result["variant"]]
        fits = [Fitted(arm, name, self.used(name), poses, result["criterion"]["prior"] == "tolerance") for name in variants]
        truth = design.get("truth")
        effects = Effects(fits[0], truth, arm.problem["variants"][truth]["parameters"], poses) if truth and not self.several else None
        self.design = Design(arm, fits, effects, design | {"scaling": result["criterion"]["scaling"]})
        self.fit, self.bounds = fits[0], [v["log_det_bound"] for v in self.several]
        weights = design.get("variants", variants)
        shares = np.array([weights[v] if isinstance(weights, dict) else 1 for v in variants], float)
        self.shares = shares / shares.sum()

    def used(self, variant):
        return [p for p in self.result["parameters"] if p["identifiable"] and (not self.several or p["variant"] == variant)]

    def value(self, name, sets, among):
        return self.design.value(name, sets, among, self.bounds, self.shares)


def check_numbers(result, meaning, chosen, among, check):
    """What is stated of the poses `chosen` beside the criterion: log det, indices, σ, errors at the test poses."""
    fit, criterion, sets = meaning.fit, result["criterion"], np.array([chosen])
    check.same("log_det", fit.log_det(sets)[0], criterion["log_det"])
    check.same("log_det_full", fit.log_det_full(sets)[0], criterion["log_det_full"])
    units = fit.column_units(criterion["scaling"], among)
    for name, value in fit.indices(sets, units).items():
        check.same(f"indices.{name}", value[0], criterion["indices"][name])
    sigma = fit.sigma(sets)[0]
    stated = {p["name"]: p["sigma"] for p in meaning.used(fit.variant)}
    for name, value in zip(fit.names, sigma):
        check.same(f"σ of {name}", value, stated[name])
    if meaning.design.test is not None and result["accuracy"]["rho0"] is not None:
        errors = fit.test_variances(sets, meaning.design.test, meaning.design.point)[0]
        check.same("rho0", np.sqrt(errors @ meaning.design.weights), result["accuracy"]["rho0"])
        for k, (mine, told) in enumerate(zip(np.sqrt(errors), result["accuracy"]["test_poses"])):
            check.same(f"error at test pose {k}", mine, told)
    if result.get("discrimination") and meaning.design.effects:
        # Less than rounding of the effects themselves is nothing.
        left = meaning.design.effects.left(sets)[0]
        if left.sum() < 1e-9 * meaning.design.effects.size(sets)[0]:
            return check.holds("an effect where nothing is left", result["discrimination"]["noncentrality"] < 1e-6)
        nominal = meaning.design.effects.by_nominal
        told = result["discrimination"]
        # A difference: as good as both sides of it.
        both = 1e-9 * meaning.design.effects.size(sets)[0]
        for key, mine in (("noncentrality", left.sum()), ("by_nominal", left[0] if nominal else None),
                          ("by_tolerance", left[nominal:].sum() if len(left) > nominal else None)):
            if mine is None or told[key] is None or abs(mine - told[key]) > both:
                check.same(key, mine, told[key])
        check_power(told, left.sum(), len(chosen), fit, criterion["prior"] == "tolerance", check)


def check_power(told, T, poses, fit, prior, check):
    """Chance that residuals exceed what the fitted variant leaves 95 times of 100."""
    readings = poses * len(fit.arm.columns) + prior * len(fit.names)
    power = lambda T, freedom: stats.ncx2.sf(stats.chi2.isf(told["level"], freedom), freedom, T)
    check.same("readings", readings, told["readings"])
    check.same("degrees of freedom", readings - len(fit.names), told["degrees_of_freedom"])
    check.same("power", power(T, readings - len(fit.names)), told["power"])
    if told["power_along_effect"] is not None:
        check.same("power along the effect", power(T, 1), told["power_along_effect"])
    k = told["repetitions"]
    if k is not None:
        enough = lambda k: power(k * T, k * readings - len(fit.names)) >= told["wanted_power"]
        check.holds(f"{k} repetitions", enough(k) and (k == 1 or not enough(k - 1)))


def sets_of(count, size, repeats):
    choose = itertools.combinations_with_replacement if repeats == "allow" else itertools.combinations
    return np.array(list(choose(range(count), size)))


def check_certificate(name, result, meaning, chosen, count, check):
    """Every set of the list by brute force: none above the bound, the best is the optimum where one is proved."""
    certificate, reserve = result["certificate"]["candidates"], result["criterion"]["reserve"]
    check.holds("a bound, but the documentation has none" if certificate else "no bound", (certificate is None) == (name in UNBOUNDED))
    among = np.arange(count)
    sets = sets_of(count, len(chosen), meaning.arm.problem["design"].get("repeats", "forbid"))

    def potential(which):
        values = meaning.value(name, which, among)
        ranked = values if name in UNBOUNDED else meaning.design.potential(name, values, which)
        return np.where(np.isfinite(ranked), ranked, -np.inf)
    everything, own = potential(sets), potential(np.array([chosen]))[0]
    best, reached = everything, own
    if reserve:
        # What is maximised is what is left when the pose that hurts most is lost.
        best = np.min([potential(np.delete(sets, k, axis=1)) for k in range(sets.shape[1])], axis=0)
        reached = min(potential(np.array([np.delete(chosen, k)]))[0] for k in range(len(chosen)))
    check.holds(f"no set has {reached:.12g}, the most is {np.max(best):.12g}", reached <= np.max(best) + NOISE)
    if certificate is None:
        return
    bound, h = certificate["bound"], meaning.design.degree(name)
    check.holds(f"bound {bound:.12g} below a set that has {np.max(everything):.12g}", np.max(everything) <= bound + NOISE)
    check.same("efficiency", np.exp((own - bound) / h), certificate["efficiency"])
    if certificate["optimal"]:
        check.holds(f"proved optimum {reached:.12g}, but a set has {np.max(best):.12g}", np.max(best) <= reached + NOISE)


def check_shares(name, result, meaning, chosen, among, check):
    """What is left without a pose, and how much of the information it is; variants of a plan for several."""
    share, sets = [p["contribution"] for p in result["poses"]], np.array([chosen])
    if result["criterion"]["prior"] == "none":
        check.same("sum of contributions", sum(share), 1.0)
    without = np.array([np.delete(chosen, k) for k in range(len(chosen))])
    if name not in UNBOUNDED:
        potential = lambda which: meaning.design.potential(name, meaning.value(name, which, among), which)
        left = np.exp((potential(without) - potential(sets)) / meaning.design.degree(name))
        for pose, mine in zip(result["poses"], left):
            # O4 may grow with a pose less: then nothing of it is lost.
            check.same("efficiency_without", min(mine, 1.0) if np.isfinite(mine) else 0.0, pose["efficiency_without"])
    candidates = sets_of(len(among), len(chosen), meaning.arm.problem["design"].get("repeats", "forbid"))
    for variant, fit in zip(meaning.several, meaning.design.fits):
        own, bound = fit.log_det(sets)[0], variant["log_det_bound"]
        check.same("log_det of a variant", own, variant["log_det"])
        check.same("efficiency of a variant", np.exp((own - bound) / fit.size), variant["efficiency"])
        check.holds("bound of a variant below a set", np.nanmax(fit.log_det(candidates)) <= bound + NOISE)


def check_evaluation(evaluation, arm, poses, chosen, check):
    """The scores of a list of poses by every criterion; no set of the candidates beats what a proved share says."""
    meaning, among = Definitions(arm, evaluation, poses), np.arange(len(poses.Q))
    repeats = arm.problem["design"].get("repeats", "forbid")
    sets, listed = sets_of(len(poses.Q), len(chosen), repeats), np.array([chosen])
    check_numbers(evaluation, meaning, chosen, among, check)
    for score in evaluation["scores"]:
        name = score["criterion"]
        if name in ("compound", "maximin"):
            continue
        own = meaning.value(name, listed, among)
        # What fitting leaves of an effect that it takes up altogether is rounding.
        check.same(f"score {name}", own[0], score["value"], floor=1e-6 if name == "discriminate" else 1e-12)
        if score["efficiency"] is not None:
            most = np.nanmax(meaning.design.potential(name, meaning.value(name, sets, among), sets))
            share = np.exp((meaning.design.potential(name, own, listed)[0] - most) / meaning.design.degree(name))
            check.holds(f"score {name}: {score['efficiency']:.9g} proved, {share:.9g} true", score["efficiency"] <= share * (1 + NOISE))
    check_changes(evaluation, meaning.fit, chosen, [k for k in among if repeats == "allow" or k not in chosen], check)


def check_changes(evaluation, fit, chosen, free, check):
    """Which pose is missed least, which candidate brings most: by log det, the list's criterion, or by what is left of it when
    the pose that hurts most is lost."""
    whole = fit.log_det(np.array([chosen]))[0]
    for what, sets in (("drop", [np.delete(chosen, k) for k in range(len(chosen))]), ("add", [[*chosen, k] for k in free])):
        if what == "add" and evaluation["criterion"]["reserve"]:
            continue  # A reserve counts the loss of new poses only (docs/commands.md): one new pose has none.
        sets = np.array(sets)
        ranked = value = fit.log_det(sets)
        if evaluation["criterion"]["reserve"]:
            ranked = np.min([np.nan_to_num(fit.log_det(np.delete(sets, k, axis=1)), nan=-np.inf) for k in range(sets.shape[1])], axis=0)
        if evaluation[what] and np.isfinite(ranked).any():
            # Of several that are as good, any: the one that is nearest to what is stated.
            best = value[ranked > np.nanmax(ranked) - NOISE]
            best = best[np.argmin(np.abs(best - evaluation[what]["log_det"]))]
            check.same(f"{what}: log_det", best, evaluation[what]["log_det"])
            check.same(f"{what}: efficiency", np.exp((best - whole) / fit.size), evaluation[what]["efficiency"])
