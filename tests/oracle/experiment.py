"""A robot seen by an instrument, pose by pose: readings, their covariance and their derivative by every parameter.

What stays at a pose is one displacement of the tip a visit, common to all that is read then."""
import dataclasses

import numpy as np

from arm import frame
from denavit_hartenberg import DenavitHartenbergArm
from instruments import Targets, block_diagonal, distance_noise, instrument_of
from parallel_robots import CompensatorLinkage, Delta, FiveBar, SixLegs
from quantities import matching, point, rotation_vector, si, slopes, turn
from serial_arm import SerialArm


@dataclasses.dataclass(frozen=True)
class Visit:
    """A robot at one configuration. `nominal`: the parameters that everything is linearised at."""
    q: tuple
    load: str | None
    station: str | None
    nominal: dict
    second: tuple | None = None
    hidden: frozenset = frozenset()


def robot_of(spec, folder, convention):
    if "urdf" in spec:
        return SerialArm(spec, folder) if convention == "frames" else DenavitHartenbergArm(spec, folder, convention)
    robots = {"six_pus": SixLegs, "gough": SixLegs, "five_bar": FiveBar, "delta": Delta, "compensator": CompensatorLinkage}
    return robots[spec["model"]](spec)


def stood_off(X, off):
    """The tip displaced by a translation and a rotation about itself, in the axes of the measurement frame."""
    if off is None:
        return X
    angle = np.linalg.norm(off[3:])
    return frame(X[:3, 3] + off[:3], (turn(off[3:] / angle, angle) if angle else np.eye(3)) @ X[:3, :3])


def convention_of(variant):
    words = variant["parameters"] if isinstance(variant["parameters"], list) else [variant["parameters"]]
    return next((word for word in words if word in ("dh", "mdh")), "frames")


class Experiment:
    """The robot and the instrument of a problem with the nominal values of one of its variants."""

    def __new__(cls, problem, folder, variant):
        measurement = problem["measurement"]
        if problem["robot"].get("model") == "compensator":
            return super().__new__(Pins)
        if measurement["type"] == "joints":
            return super().__new__(JointSensors)
        pairs, loaded = "between" in measurement, measurement.get("load") == "loaded_minus_unloaded"
        if pairs and loaded:
            return super().__new__(BallBarDifference)
        return super().__new__(BallBar if pairs else LoadDifference if loaded else Experiment)

    def __init__(self, problem, folder, variant):
        self.problem, self.measurement = problem, problem["measurement"]
        self.robot = robot_of(problem["robot"], folder, convention_of(variant))
        self.own_names = problem["robot"].get("parameter_names", {})
        self.repeats = self.measurement.get("repeats", 1)
        stays = self.measurement.get("repeatability", 0)
        stays = stays if isinstance(stays, dict) else {"position": stays}
        self.stays = np.repeat([si(stays["position"]), si(stays.get("rotation", 0))], 3)
        self.nominal, self.stands, self.nominal_tips = dict(self.robot.nominal), dict(self.robot.stands), {}
        self.add_instrument()
        # What targets or a mounted board or camera say of the tip's frame is not said twice: there the tool has no parameters.
        free = [name for name in self.nominal if self.measurement["type"] in ("pose", "inclination") or not name.startswith("tool.")]
        for pattern, value in variant.get("nominal", {}).items():
            for name in matching(free, self.own_names.get(pattern, pattern)):
                self.nominal[name] = si(value) - self.stands.get(name, 0.0)

    def add_instrument(self):
        self.instrument = instrument_of(self.measurement)
        self.nominal |= self.instrument.nominal
        self.stands |= self.instrument.stands

    def visit(self, names, configuration, load=None, station=None, hidden=()):
        known = dict(zip(names, configuration))
        first = tuple(known[name] for name in self.robot.coordinates)
        pair = [known[f"{name}.second"] for name in self.robot.coordinates if f"{name}.second" in known]
        return Visit(first, load, station, self.nominal, tuple(pair) or None, frozenset(hidden))

    # How the readings come about. `joints` and `off`: what joints or actuators err by, how far the tip stands off.

    def readings(self, visit, values, joints=None, off=None):
        nominal = self.nominal_tip(visit)
        X = nominal if values is self.nominal and joints is None else self.robot.tip(visit, values, joints)
        return self.instrument.read(stood_off(X, off), values, visit.station, nominal)

    def nominal_tip(self, visit):
        key = visit.q, visit.load
        if key not in self.nominal_tips:
            self.nominal_tips[key] = self.robot.tip(visit, self.nominal)
        return self.nominal_tips[key]

    def noise(self, visit):
        return self.instrument.noise(self.nominal_tip(visit), self.nominal, visit.station)

    def displacements(self):
        return self.stays

    def joint_noise(self):
        return self.robot.reading_noise

    # What a plan is judged by.

    def covariance(self, visit):
        V = self.noise(visit) / self.repeats
        stays, joints = self.displacements(), self.joint_noise()
        if np.any(stays):
            A = slopes(lambda off: self.readings(visit, self.nominal, off=off), len(stays)) * stays
            V = V + A @ A.T
        if np.any(joints):
            A = slopes(lambda error: self.readings(visit, self.nominal, joints=error), len(joints)) * joints
            V = V + A @ A.T
        return V

    def column(self, visit, name, rule):
        (difference, step), value = rule, self.nominal[name]
        return difference(lambda h: self.readings(visit, self.nominal | {name: value + h}), step)

    def block(self, visit, names, rules):
        """Derivatives of what is read by rules of differences with their steps, whitened: covariance = L Lᵀ, L⁻¹ G."""
        G = np.array([self.column(visit, name, rule) for name, rule in zip(names, rules)]).T
        read = self.read_rows(visit)
        return np.linalg.solve(np.linalg.cholesky(self.covariance(visit)[np.ix_(read, read)]), G[read])

    def displaced_block(self, visit, sizes):
        """What is read along displacements of the tip of these sizes, whitened as block()."""
        A = slopes(lambda off: self.readings(visit, self.nominal, off=off), 6) * sizes
        read = self.read_rows(visit)
        return np.linalg.solve(np.linalg.cholesky(self.covariance(visit)[np.ix_(read, read)]), A[read])

    def size(self, visit):
        """Of the readings in units of their noise, as numbers that are rounded."""
        return np.linalg.norm(self.rounded(visit) / np.sqrt(np.diag(self.noise(visit)) / self.repeats))

    def rounded(self, visit):
        return self.readings(visit, self.nominal)

    def read_rows(self, visit):
        """A target that is hidden is not read."""
        if not visit.hidden:
            return np.arange(len(self.noise(visit)))
        names, width = list(self.instrument.targets), len(self.instrument.components)
        return np.concatenate([np.arange(width) + k * width for k, name in enumerate(names) if name not in visit.hidden])

    def last(self, visit):
        """Where the robot stands at the end."""
        return visit

    def moved(self, visit, values, at):
        """A point of the tip and how far the tip is turned from its nominal pose, in the measurement frame."""
        X = self.robot.tip(visit, values)
        return np.concatenate([point(X, at), rotation_vector(X[:3, :3] @ self.nominal_tip(visit)[:3, :3].T)])


class LoadDifference(Experiment):
    """Under a load less under the first load case: what stays at a pose is the same in both."""

    def unloaded(self, visit):
        return dataclasses.replace(visit, load=next(iter(self.problem["robot"]["elastostatic"]["loads"])))

    def readings(self, visit, values, joints=None, off=None):
        return super().readings(visit, values) - super().readings(self.unloaded(visit), values)

    def rounded(self, visit):
        return super().readings(visit, self.nominal)

    def noise(self, visit):
        return super().noise(visit) + super().noise(self.unloaded(visit))

    def displacements(self):
        return np.zeros(6)

    def joint_noise(self):
        return np.zeros(len(self.robot.reading_noise))


class BallBar(Experiment):
    """How far targets travel from one configuration to another: two visits, each with a displacement and joints of its own."""

    def add_instrument(self):
        self.instrument = Targets(self.measurement)
        self.nominal |= self.instrument.nominal
        self.stands |= self.instrument.stands

    def readings(self, visit, values, joints=None, off=None):
        ends = []
        for k, q in enumerate((visit.q, visit.second)):
            half = None if joints is None else np.split(joints, 2)[k]
            end = dataclasses.replace(visit, q=q)
            X = self.nominal_tip(end) if values is self.nominal and half is None else self.robot.tip(end, values, half)
            places = self.instrument.places(stood_off(X, None if off is None else np.split(off, 2)[k]), values)
            ends.append(np.array(list(places.values())))
        return np.linalg.norm(ends[1] - ends[0], axis=1)

    def last(self, visit):
        return dataclasses.replace(visit, q=visit.second)

    def noise(self, visit):
        return distance_noise(self.measurement["device"], BallBar.readings(self, visit, self.nominal))

    def displacements(self):
        return np.tile(self.stays, 2)

    def joint_noise(self):
        return np.tile(self.robot.reading_noise, 2)


class BallBarDifference(LoadDifference, BallBar):
    """How much further targets travel under a load."""


class JointSensors(Experiment):
    """Redundant sensors of a closed chain against what its actuators say."""

    def add_instrument(self):
        chosen = self.measurement.get("sensors", self.robot.sensor_names)
        self.chosen = [k for k, name in enumerate(self.robot.sensor_names) if name in chosen]

    def readings(self, visit, values, joints=None, off=None):
        return self.robot.sensors(visit, values, joints)[self.chosen]

    def noise(self, visit):
        return si(self.measurement["device"]["noise"])**2 * np.eye(len(self.chosen))


class Pins(Experiment):
    """Markers on both pins of a compensator's linkage, each a point of the measurement frame."""

    def add_instrument(self):
        self.instrument = instrument_of(self.measurement)
        self.stays = np.zeros(6)

    def readings(self, visit, values, joints=None, off=None):
        return self.robot.pins(visit, values, joints)

    def noise(self, visit):
        return block_diagonal([self.instrument.of_point(p) for p in np.split(self.readings(visit, self.nominal), 2)])
