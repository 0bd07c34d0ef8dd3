"""What a plan states, computed again from its poses: information as a sum, σ from its inverse, indices from singular values."""
import numpy as np

from quantities import fine_slope, matching, si, slope, vector

# Steps for differences, by unit. What has another unit (springs, lenses) moves readings by little more than their rounding unless
# the step is a good share of the tolerance.
STEPS = {"m": 2e-4, "rad": 5e-4, "1": 1e-3}


def default_tolerance(name, unit, value):
    """1σ where the problem file says nothing, as the documentation lists it; None where it says nothing either."""
    owner, _, kind = name.partition("@")[0].rpartition(".")
    turns = kind in ("rx", "ry", "rz")
    if owner in ("camera", "board", "", "compensator", "q2") or kind == "stiffness":
        return 0.01 if name.startswith(("kappa", "K_")) else None
    if owner in ("base", "tool") or owner.startswith("station."):
        return np.radians(1) if turns else 0.005 if owner == "tool" else 0.01
    if owner in ("plane", "line"):
        return 0.01 if kind in ("offset", "u", "v") and unit == "m" else np.radians(1)
    if owner == "sensor":
        return np.radians(1) if turns else 0.005
    if owner.startswith(("target.", "anchor.")):
        return 1e-3
    if kind == "gear":
        return 1e-3
    if "compliance" in kind:
        return max(0.3e-6, 0.3 * value)
    if owner.startswith("leg_"):
        return 1e-3 if kind in ("ux", "uy", "offset", "sensor_offset", "azimuth") else 0.5e-3
    return np.radians(0.05) if unit == "rad" else 0.5e-3


class Parameters:
    """Those of one variant as the plan lists them."""

    def __init__(self, plan, experiment, variant_name):
        listed = [p for p in plan["parameters"] if p.get("variant", variant_name) == variant_name]
        self.listed, self.used = listed, [p for p in listed if p["identifiable"]]
        self.model_names = {p["name"]: experiment.own_names.get(p["name"], p["name"]) for p in listed}
        self.tolerance = np.array([p["tolerance"] for p in self.used])
        self.interest = np.array([p["role"] == "interest" for p in self.used])
        self.names = [self.model_names[p["name"]] for p in self.used]
        self.rules = [rule_of(p) for p in self.used]
        self.dropped = [p for p in listed if not p["identifiable"]]


def rule_of(parameter):
    step = STEPS.get(parameter["unit"])
    return (slope, step) if step else (fine_slope, 0.05 * parameter["tolerance"])


def visits_of(plan, experiment):
    for pose in plan["poses"]:
        hidden = [sight["target"] for sight in pose.get("targets", []) if sight["visible"] is False]
        yield experiment.visit(pose["names"], pose["configuration"], pose.get("load_case"), pose.get("station"), hidden)


def correlated(effect, experiment, visits):
    """Covariance of all readings, whitened pose by pose, with a smooth displacement of the tip between them: of angles alone."""
    sizes = np.repeat([effect["size"], effect["rotation"]], 3)
    A = [experiment.displaced_block(visit, sizes) for visit in visits]
    q = np.array([visit.q for visit in visits])
    squares = sum((f(q)[:, None] - f(q)[None])**2 for f in (np.cos, np.sin)).sum(axis=2)
    k = np.exp(-squares / (2 * effect["length"]**2))
    whole = np.block([[k[i, j] * A[i] @ A[j].T for j in range(len(A))] for i in range(len(A))])
    return whole + np.eye(len(whole))


class Information:
    """M = GᵀG, G the whitened blocks of all poses stacked, in units of tolerance; and what follows from it.

    Singular values of G and its pseudo-inverse say the same as those of M and its inverse, with half as many digits lost."""

    def __init__(self, plan, experiment, parameters):
        self.poses = list(visits_of(plan, experiment))
        self.parameters, p = parameters, parameters
        everything = p.used + p.dropped
        names, rules = [p.model_names[each["name"]] for each in everything], [rule_of(each) for each in everything]
        G = np.vstack([experiment.block(visit, names, rules) for visit in self.poses]) * [each["tolerance"] for each in everything]
        if "unmodelled" in plan:
            G = np.linalg.solve(np.linalg.cholesky(correlated(plan["unmodelled"], experiment, self.poses)), G)
        self.rows, self.dropped = np.hsplit(G, [len(p.used)])
        self.rounding = self.errors_of_differences(experiment)
        self.measured = self.rows
        self.rms_effect = np.linalg.norm(self.rows, axis=0) / p.tolerance / np.sqrt(len(self.poses))
        if plan["criterion"]["prior"] == "tolerance":
            # One more measurement of every parameter, as good as its tolerance.
            self.rows = np.vstack([self.rows, np.eye(len(p.names))])
        size = np.linalg.norm(self.rows, axis=0)
        self.root = np.linalg.pinv(self.rows / size, rcond=1e-14) / size[:, None]
        self.sigma = np.linalg.norm(self.root, axis=1) * p.tolerance

    def errors_of_differences(self, experiment):
        """The largest relative error that rounded readings leave in a column; tenfold, for what is added up on the way to a reading."""
        size = np.sqrt(sum(experiment.size(visit)**2 for visit in self.poses))
        shown = np.linalg.norm(self.rows, axis=0) / self.parameters.tolerance * [step for _, step in self.parameters.rules]
        return 2e-15 * size / np.min(shown[shown > 0], initial=np.inf)

    def of_interest(self):
        """What the nuisance columns leave of the others, each as it stands for one tolerance."""
        inner, others = self.rows[:, self.parameters.interest], self.rows[:, ~self.parameters.interest]
        if others.shape[1] == 0:
            return inner
        Q, _ = np.linalg.qr(others)
        # Twice, so that nothing of the nuisance columns is left by rounding.
        left = inner - Q @ (Q.T @ inner)
        return left - Q @ (Q.T @ left)

    def log_det(self):
        inner = self.parameters.interest
        return 2 * np.log(np.linalg.svd(self.of_interest() / self.parameters.tolerance[inner], compute_uv=False)).sum()

    def log_det_full(self):
        return 2 * np.log(np.linalg.svd(self.rows, compute_uv=False)).sum() - 2 * np.log(self.parameters.tolerance).sum()

    def unit(self, scaling):
        """What columns are divided by: the tolerance, the inverse of the mean effect on a pose's readings, nothing."""
        p = self.parameters
        if scaling == "norm":
            # A column that these readings tell nothing of is known by its tolerance alone.
            told = self.rms_effect > 0
            return np.where(told, 1 / np.where(told, self.rms_effect, 1), p.tolerance)[p.interest]
        return (p.tolerance if scaling == "tolerance" else np.ones(len(p.names)))[p.interest]

    def indices(self, scaling):
        unit = self.unit(scaling) / self.parameters.tolerance[self.parameters.interest]
        s = np.linalg.svd(self.of_interest() * unit, compute_uv=False)
        return {"o1": np.exp(np.log(s).mean()) / np.sqrt(len(self.poses)), "o2": s[-1] / s[0], "o3": s[-1], "o4": s[-1]**2 / s[0],
                "o5": 1 / (1 / s).sum()}

    def condition(self):
        """Of the columns at equal length: how much the errors of differences grow."""
        return np.linalg.cond(self.rows / np.linalg.norm(self.rows, axis=0))

    def outside(self, column):
        """Share of a whitened column that no combination of the columns in use holds."""
        length = np.linalg.norm(column)
        if length < 1e-6:
            # One tolerance shows a millionth of the noise: nothing but rounding.
            return 0.0
        size = np.maximum(np.linalg.norm(self.measured, axis=0), 1e-12)
        fit = np.linalg.lstsq(self.measured / size, column / length, rcond=None)[0]
        return np.linalg.norm(column / length - self.measured / size @ fit)

    def sigmas_at(self, visits, experiment, at):
        """1σ of the calibrated robot at each test pose along x, y, z and about them; nuisance parameters do not count there."""
        p, found = self.parameters, []
        for visit in visits:
            moved = lambda name, h: experiment.moved(visit, visit.nominal | {name: visit.nominal[name] + h}, at)
            A = np.array([difference(lambda h: moved(name, h), step) for name, (difference, step) in zip(p.names, p.rules)]).T
            found.append(np.linalg.norm(A * np.where(p.interest, p.tolerance, 0.0) @ self.root, axis=1))
        return np.array(found)


def test_visits(problem, experiment):
    """The listed test poses, their weights, and the point of the tip whose position counts."""
    spec = problem.get("design", {}).get("test_poses") or {}
    visits = []
    loads = problem["robot"].get("elastostatic", {}).get("loads", {})
    load = spec.get("load_case", next((name for name, case in loads.items() if case), next(iter(loads), None)))
    for values in spec.get("at", []):
        visits.append(experiment.visit(experiment.robot.coordinates, [si(v) for v in values], load))
    weights = np.array(spec.get("weights", np.ones(len(visits))), float)
    return visits, weights, vector(spec.get("point", [0, 0, 0]))


def stated_tolerance(variant, parameter, model_name, value):
    """Of the variant, where later entries win; else the default."""
    found = default_tolerance(model_name, parameter["unit"], value)
    for pattern, tolerance in variant.get("tolerance", {}).items():
        if matching([parameter["name"], model_name], pattern):
            found = si(tolerance)
    return found
