"""What a plan states of one variant against the same by definition: the largest difference of each kind."""
import numpy as np

from experiment import Experiment
from quantities import si
from statements import Information, Parameters, stated_tolerance, test_visits

# Relative (of σ, indices, the criterion's value, errors) or in m and rad. Rounded readings leave 1e-12 of most derivatives, but 1e-9 of
# what moves readings by little more than their last digits; where columns are nearly dependent that counts by as much as they are
# (the condition of G with columns of equal length). Beyond 1e-6 only what this explains is let pass, and never more than 1e-4.
LIMIT, LARGEST_LIMIT = 1e-6, 1e-4
# What a plan may call dependent: at most 1e-4 of the column's effect is its own over the whole workspace, at few poses some more.
OUTSIDE = 1e-3


class Differences:
    """The largest of each kind, in the order in which kinds come up."""

    def __init__(self):
        self.largest, self.limit, self.limit_of_indices = {}, LIMIT, LIMIT

    def relative(self, kind, ours, stated, least=1e-300):
        """Below `least` nobody asks."""
        for one, other in zip(np.atleast_1d(ours), np.atleast_1d(stated), strict=True):
            self.put(kind, 0.0 if one == other else abs(one - other) / max(abs(other), least))

    def absolute(self, kind, ours, stated):
        self.put(kind, np.max(np.abs(np.subtract(ours, stated))))

    def angle(self, kind, ours, stated):
        """Whole turns do not count."""
        self.put(kind, np.max(np.abs(np.remainder(np.subtract(ours, stated) + np.pi, 2 * np.pi) - np.pi)))

    def put(self, kind, amount):
        known = self.largest.setdefault(kind, 0.0)
        # NaN is a difference, too.
        if not amount <= known:
            self.largest[kind] = amount

    def good(self):
        # The log det is twice the sum of as many logarithms as there are parameters.
        limits = {"dropped": OUTSIDE, "indices": self.limit_of_indices, "value": self.limit_of_indices, "log det": 10 * self.limit}
        return all(amount <= limits.get(kind, self.limit) for kind, amount in self.largest.items())

    def __str__(self):
        return ", ".join(f"{kind} {amount:.0e}" for kind, amount in self.largest.items())


def compare(problem, folder, plan, variant_name):
    """Differences, and the parameters that were compared."""
    found, variant = Differences(), problem["variants"][variant_name]
    experiment = Experiment(problem, folder, variant)
    parameters = Parameters(plan, experiment, variant_name)
    compare_parameters(found, variant, experiment, parameters)
    information = Information(plan, experiment, parameters)
    found.limit = max(LIMIT, min(LARGEST_LIMIT, information.rounding * information.condition()))
    found.relative("σ", information.sigma, [p["sigma"] for p in parameters.used])
    for column in information.dropped.T:
        found.put("dropped", information.outside(column))
    if "variant" in plan["parameters"][0]:
        (stated,) = [v["log_det"] for v in plan["variants"] if v["name"] == variant_name]
        found.absolute("log det", information.log_det(), stated)
        return found, parameters
    compare_criterion(found, problem, plan, experiment, information)
    for pose, visit in zip(plan["poses"], information.poses):
        compare_pose(found, pose, visit, experiment)
        compare_sights(found, problem, pose, visit, experiment)
    return found, parameters


def compare_parameters(found, variant, experiment, parameters):
    """Nominal values and tolerances."""
    for p in parameters.listed:
        model_name = parameters.model_names[p["name"]]
        value = experiment.nominal[model_name] + experiment.stands.get(model_name, 0.0)
        if p["unit"] == "rad":
            found.angle("nominal", value, p["nominal"])
        else:
            found.put("nominal", abs(value - p["nominal"]) / max(abs(value), 1e-3))
        if tolerance := stated_tolerance(variant, p, model_name, value):
            found.relative("tolerance", tolerance, p["tolerance"])


def compare_criterion(found, problem, plan, experiment, information):
    criterion = plan["criterion"]
    found.absolute("log det", information.log_det(), criterion["log_det"])
    found.absolute("log det", information.log_det_full(), criterion["log_det_full"])
    values = information.indices(criterion["scaling"])
    # Columns that are not scaled to be alike: the small singular values end in the rounding of the large ones.
    found.limit_of_indices = max(found.limit, 1e-15 / values["o2"])
    for name, value in values.items():
        found.relative("indices", value, criterion["indices"][name])
    interest = information.parameters.interest
    values["ds"] = information.log_det()
    values["a"] = -((information.sigma[interest] / information.unit(criterion["scaling"]))**2).sum()
    visits, weights, at = test_visits(problem, experiment)
    if visits:
        accuracy, moved = plan["accuracy"], information.sigmas_at(visits, experiment, at)
        mean = lambda squares: np.sqrt((weights * squares).sum() / weights.sum())
        errors = np.linalg.norm(moved[:, :3], axis=1)
        rho0 = mean(errors**2)
        found.relative("error at test poses", [rho0, *errors], [accuracy["rho0"], *accuracy["test_poses"]], 1e-7)
        if "rotation" in accuracy:
            found.relative("error at test poses", mean((moved[:, 3:]**2).sum(axis=1)), accuracy["rotation"])
            found.absolute("error at test poses", moved, accuracy["test_pose_sigmas"])
        values |= {"test_pose": -rho0**2, "test_pose_max": -max(errors)**2}
    if criterion["name"] in values and not criterion["reserve"]:
        found.relative("value", values[criterion["name"]], criterion["value"], 1e-14 if "test_pose" in criterion["name"] else 1e-300)


def compare_pose(found, pose, visit, experiment):
    robot = experiment.robot
    if "tool_pose" in pose and hasattr(robot, "tip"):
        X, stated = robot.tip(experiment.last(visit), experiment.nominal), pose["tool_pose"]
        found.absolute("tool pose", X[:3, 3], stated["position"])
        found.absolute("tool pose", X[:3, :3], matrix(stated["quaternion_xyzw"]))
    if pose.get("actuators"):
        ends = [""] if visit.second is None else ["", ".second"]
        for end, q in zip(ends, (visit.q, visit.second)):
            stated = [pose["actuators"][name + end] for name in robot.actuator_names]
            rho = robot.actuators(np.array(q), experiment.nominal)
            (found.absolute if robot.legs == 6 else found.angle)("actuators", rho, stated)


def compare_sights(found, problem, pose, visit, experiment):
    """Where the instrument sees its targets, and which it sees."""
    if not pose.get("targets"):
        return
    X, sight_of = experiment.robot.tip(visit, experiment.nominal), problem.get("workspace", {}).get("line_of_sight", {})
    places = experiment.instrument.seen(X, experiment.nominal, visit.station)
    for sight in pose["targets"]:
        p = places[sight["target"]]
        found.absolute("sights", p, sight["position"])
        found.absolute("sights", np.linalg.norm(p), sight["distance"])
        found.angle("sights", [np.arctan2(p[1], p[0]), np.arctan2(p[2], np.hypot(p[0], p[1]))], [sight["azimuth"], sight["elevation"]])
        if sight["incidence"] is not None:
            faces = sight_of["normals"].get(sight["target"], sight_of["normals"].get("*"))
            incidence = experiment.instrument.incidence(X, faces, p, experiment.nominal, visit.station)
            found.absolute("sights", incidence, sight["incidence"])
            if not set(sight_of) - {"visible", "acceptance", "normals"}:
                # Nothing else hides it.
                found.put("sights", 0.0 if sight["visible"] == (incidence <= si(sight_of["acceptance"])) else np.inf)


def matrix(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
