"""Robots with closed loops by definition: loop equations, solved by Newton's method for where the platform stands.

Parameters: base.*, those of the legs (values of the problem file, not what they differ by), tool.*."""
import numpy as np

from arm import frame
from quantities import displacement, placement, point, si, six, stands_at, turn_rpy, vector


def differences(f, x):
    """Derivative of f at x, good enough for a step of Newton's."""
    return np.array([(f(x + h) - f(x - h)) / 2e-6 for h in 1e-6 * np.eye(len(x))]).T


def newton(f, x, derivative=None):
    """A root of f near x; with a `derivative` that is good nearby, that one at every step."""
    for _ in range(60):
        step = np.linalg.solve(differences(f, x) if derivative is None else derivative, f(x))
        x = x - step
        if np.max(np.abs(step)) < 1e-15:
            return x
    if np.max(np.abs(step)) > 1e-12:
        raise ArithmeticError("the loops do not close")
    return x


class ClosedChain:
    """A robot says where its platform is (`platform`: coordinates → frame), what its loops miss (`loops`: coordinates, actuators,
    legs → m; `legs_of`: parameters → legs) and where its actuators stand at a configuration (`actuators`)."""

    def begin(self, spec, coordinates, own, noise):
        self.X_MeasureBase, self.coordinates = placement(spec.get("placement")), coordinates
        self.nominal, self.stands = six("base") | own | six("tool"), stands_at("base", self.X_MeasureBase)
        self.reading_noise = np.full(self.legs, si(noise))
        self.actuator_names = [f"leg_{i + 1}.rho" for i in range(self.legs)]
        self.own, self.known = list(own), {}

    def at(self, pose):
        """Where the nominal robot's actuators stand at a pose, and the derivative of its loops there."""
        if pose.q not in self.known:
            q, legs = np.array(pose.q), self.legs_of(pose.nominal)
            rho = self.actuators(q, pose.nominal)
            self.known[pose.q] = rho, differences(lambda x: self.loops(x, rho, legs), q)
        return self.known[pose.q]

    def settled(self, pose, values, off=None):
        """The platform's coordinates while the actuators stand where the nominal robot has them at this pose."""
        if off is None and all(values[name] == pose.nominal[name] for name in self.own):
            return np.array(pose.q)
        rho, derivative = self.at(pose)
        stand, legs = rho if off is None else rho + off, self.legs_of(values)
        return newton(lambda x: self.loops(x, stand, legs), np.array(pose.q), derivative)

    def tip(self, pose, values, off=None):
        X = self.platform(self.settled(pose, values, off))
        return self.X_MeasureBase @ displacement(values, "base") @ X @ displacement(values, "tool")


class SixLegs(ClosedChain):
    """Six legs of constant length on prismatic base joints (6-PUS), or of variable length (Gough)."""
    legs = 6

    def __init__(self, spec):
        self.slides, own = spec["model"] == "six_pus", {}
        for i, leg in enumerate(spec["legs"], 1):
            own |= {f"leg_{i}.a{axis}": value for axis, value in zip("xyz", joint_centre(leg["a"]))}
            own |= {f"leg_{i}.b{axis}": value for axis, value in zip("xyz", joint_centre(leg["b"]))}
            if self.slides:
                u = vector(leg.get("u", [0, 0, 1]))
                own |= {f"leg_{i}.ux": u[0] / np.linalg.norm(u), f"leg_{i}.uy": u[1] / np.linalg.norm(u)}
            own[f"leg_{i}.l"] = si(leg.get("l", 0))
        self.upwards = np.array([np.sign(vector(leg.get("u", [0, 0, 1]))[2]) for leg in spec["legs"]])
        self.kappa = [f"kappa_{i}" for i in range(1, 7)]
        self.K = [f"K_{i}{j}" for i in range(1, 7) for j in range(1, 7)]
        if self.slides:
            own |= {name: 0.0 for name in ["kappa", *self.kappa, *self.K]}
        self.X_BaseReference, self.at_reference = placement(spec["reference"]), np.zeros(6)
        self.begin(spec, ["x", "y", "z", "rx", "ry", "rz"], own, spec["actuators"].get("noise", 0))
        self.at_reference = self.actuators(np.zeros(6), self.nominal)

    def platform(self, x):
        return frame(self.X_BaseReference[:3, 3] + x[:3], turn_rpy(*x[3:]) @ self.X_BaseReference[:3, :3])

    def legs_of(self, values):
        """Base joints a, platform joints b, lengths; directions u of the slides and how the platform gives way there: b moves along its z
        by `gives` times how far the actuators have moved."""
        a, b, l = ([values[f"leg_{i}.{part}"] for i in range(1, 7) for part in parts]
                   for parts in (("ax", "ay", "az"), ("bx", "by", "bz"), ("l",)))
        u, gives = np.zeros((6, 3)), np.zeros((6, 6))
        if self.slides:
            ux, uy = np.array([[values[f"leg_{i}.ux"], values[f"leg_{i}.uy"]] for i in range(1, 7)]).T
            u = np.array([ux, uy, self.upwards * np.sqrt(1 - ux**2 - uy**2)]).T
            gives = np.array([values[name] for name in self.K]).reshape(6, 6)
            gives = gives + np.diag([values["kappa"] + values[name] for name in self.kappa])
        return np.reshape(a, (6, 3)), np.reshape(b, (6, 3)), np.array(l), u, gives

    def loops(self, x, rho, legs):
        """l - ‖p + R b - a - ρ u‖, where the actuators lengthen the legs l + ρ - ‖p + R b - a‖."""
        a, b, l, u, gives = legs
        X = self.platform(x)
        h = b @ X[:3, :3].T + X[:3, 3] - a - rho[:, None] * u
        if self.slides:
            h = h + np.outer(gives @ (rho - self.at_reference), X[:3, 2])
        else:
            l = l + rho
        return l - np.sqrt((h * h).sum(axis=1))

    def actuators(self, q, values):
        if not self.slides:
            return -self.loops(q, np.zeros(6), self.legs_of(values))
        a, b, l, u, gives = self.legs_of(values)
        # The lower of the two places on the slide from which a leg reaches the platform: from far below it is met first.
        rho = newton(lambda rho: self.loops(q, rho, (a, b, l, u, 0 * gives)), np.full(6, -3.0))
        return newton(lambda rho: self.loops(q, rho, (a, b, l, u, gives)), rho)


def joint_centre(spec):
    if isinstance(spec, dict):
        radius, angle = si(spec["radius"]), si(spec["angle"])
        return np.array([radius * np.cos(angle), radius * np.sin(angle), si(spec.get("z", 0))])
    return vector(spec)


class FiveBar(ClosedChain):
    """Two legs of two links from driven joints to one point, in the x-y plane of the base. leg_i.elbow: a sensor there."""
    legs = 2

    def __init__(self, spec):
        own = {}
        for i, leg in enumerate(spec["legs"], 1):
            own |= {f"leg_{i}.ax": si(leg["base"][0]), f"leg_{i}.ay": si(leg["base"][1])}
            own |= {f"leg_{i}.proximal": si(leg["proximal"]), f"leg_{i}.distal": si(leg["distal"])}
            own |= {f"leg_{i}.offset": 0.0, f"leg_{i}.sensor_offset": 0.0}
        self.sides = [1 if leg["elbow"] == "left" else -1 for leg in spec["legs"]]
        self.begin(spec, ["x", "y"], own, spec.get("encoder_noise", 0))
        self.sensor_names = ["leg_1.elbow", "leg_2.elbow"]

    def platform(self, x):
        return frame((x[0], x[1], 0))

    def legs_of(self, values):
        return [[values[f"leg_{i}.{key}"] for key in ("ax", "ay", "proximal", "distal", "offset")] for i in (1, 2)]

    def distal_links(self, x, rho, legs):
        """From the elbow to the point, leg by leg; and the direction of the proximal link."""
        for angle, (ax, ay, proximal, _, offset) in zip(rho, legs):
            direction = np.array([np.cos(angle + offset), np.sin(angle + offset)])
            yield x - np.array([ax, ay]) - proximal * direction, direction

    def loops(self, x, rho, legs):
        return np.array([leg[3] - np.linalg.norm(link) for leg, (link, _) in zip(legs, self.distal_links(x, rho, legs))])

    def actuators(self, q, values):
        """By the law of cosines; the elbow to the left or to the right of the line from base to point."""
        found = []
        for side, (ax, ay, proximal, distal, offset) in zip(self.sides, self.legs_of(values)):
            line = np.array(q) - [ax, ay]
            reach = np.linalg.norm(line)
            inner = np.arccos((proximal**2 + reach**2 - distal**2) / (2 * proximal * reach))
            found.append(np.arctan2(line[1], line[0]) + side * inner - offset)
        return np.array(found)

    def sensors(self, pose, values, off=None):
        """From the proximal link's direction to the distal link's, less the sensor's own offset."""
        rho, x = self.at(pose)[0], self.settled(pose, values, off)
        links = self.distal_links(x, rho if off is None else rho + off, self.legs_of(values))
        return np.array([np.arctan2(along[0] * link[1] - along[1] * link[0], along @ link) - values[f"leg_{i}.sensor_offset"]
                         for i, (link, along) in enumerate(links, 1)])


class Delta(ClosedChain):
    """Three arms on a base circle at 0, 120 and 240 degrees; a platform that keeps its attitude."""
    legs = 3

    def __init__(self, spec):
        own = {}
        for i in (1, 2, 3):
            own |= {f"leg_{i}.{key}": si(spec[key]) for key in ("base_radius", "platform_radius", "arm", "forearm")}
            own |= {f"leg_{i}.offset": 0.0, f"leg_{i}.azimuth": np.radians(120 * (i - 1))}
        self.begin(spec, ["x", "y", "z"], own, spec.get("encoder_noise", 0))

    def platform(self, x):
        return frame(x)

    def legs_of(self, values):
        keys = ("base_radius", "platform_radius", "arm", "forearm", "offset", "azimuth")
        return [[values[f"leg_{i}.{key}"] for key in keys] for i in (1, 2, 3)]

    def loops(self, x, rho, legs):
        found = []
        for angle, (base, platform, arm, forearm, offset, azimuth) in zip(rho, legs):
            outwards, below = np.array([np.cos(azimuth), np.sin(azimuth), 0]), angle + offset
            elbow = (base + arm * np.cos(below)) * outwards - np.array([0, 0, arm * np.sin(below)])
            found.append(forearm - np.linalg.norm(x + platform * outwards - elbow))
        return np.array(found)

    def actuators(self, q, values):
        """Of both solutions the one with the elbow outwards, which Newton's method finds from an arm that points outwards."""
        return newton(lambda rho: self.loops(np.array(q), rho, self.legs_of(values)), np.zeros(3))


class CompensatorLinkage:
    """The pins of a gravity compensator about the axis of its joint, z: P0 fixed, P1 on the link (alpha = atan2(ax, ay))."""

    def __init__(self, spec):
        self.coordinates, self.stands = ["q2"], {}
        self.nominal = {key: si(spec[key]) for key in ("L", "ax", "ay")} | {"q2.offset": 0.0} | six("base")
        self.reading_noise = np.array([si(spec.get("encoder_noise", 0))])

    def pins(self, pose, values, off=None):
        angle, X = pose.q[0] + values["q2.offset"] + (0 if off is None else off[0]), displacement(values, "base")
        return np.concatenate([point(X, np.array([-values["ax"], -values["ay"], 0])),
                               point(X, values["L"] * np.array([np.sin(angle), np.cos(angle), 0]))])
