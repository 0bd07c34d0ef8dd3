"""Simulated robots as they are: arms of eleven kinds with effects that a geometric model lacks (numpy, own kinematics).

`arms()` gives the kinds, `Pool(arm, ...)` configurations with the derivative of the readings by every geometric
parameter, `effect(pool, rng)` the displacement of the targets by one drawn robot's effects, of unit size after the fit.
Sizes against the repeatability: docs/real-data.md, "Robots as they are"."""
import numpy as np

GRAVITY = np.array([0, 0, -9.81])
# Share of robots with each effect, and its typical weight where present.
CATALOGUE = {"joint compliance": (1.0, 1.0), "link compliance": (0.7, 0.6), "eccentricity": (0.8, 0.7),
             "gear": (0.8, 0.5), "coupling": (0.4, 0.5), "backlash": (0.5, 0.5), "bearing": (0.6, 0.6),
             "temperature": (0.3, 0.4), "smooth": (0.8, 0.8)}
# Residual after a geometric calibration over what stays at a pose and is no effect (repeatability, instrument).
RATIO = (0.5, 5.0)


def rotation(w, angle):
    """Rodrigues, one angle per row: n × 3 × 3."""
    K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    s, c = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return np.eye(3) + s * K + c * (K @ K)


class Arm:
    """Axes w_j through o_j at zero, targets beyond the last axis, limits; lengths m, angles rad."""

    def __init__(self, name, joints, targets, limits):
        self.name = name
        self.sliding = np.array([kind == "P" for kind, _, _ in joints])
        self.w = np.array([w for _, w, _ in joints], float)
        self.o = np.array([o for _, _, o in joints], float)
        self.targets = np.atleast_2d(np.array(targets, float))
        self.limits = np.array(limits, float)

    @property
    def joints(self):
        return len(self.w)

    def place(self, q):
        """Rotation before each joint (and behind the last), images of the axes' points and of the targets."""
        n = len(q)
        R, t = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
        rotations, points = [R], []
        for j in range(self.joints):
            points.append(R @ self.o[j] + t)
            if self.sliding[j]:
                t = t + (R @ self.w[j]) * q[:, j, None]
            else:
                turn = rotation(self.w[j], q[:, j])
                t = R @ self.o[j] + t - (R @ turn) @ self.o[j]
                R = R @ turn
            rotations.append(R)
        return rotations, points, np.stack([R @ p + t for p in self.targets], 1), (R, t)

    def derivative(self, q):
        """n × 3·targets × columns: base (6), each joint's frame (3 turns, 3 shifts in that frame), each target (3)."""
        rotations, points, tips, _ = self.place(q)
        n, k = tips.shape[:2]
        columns = []

        def turn(axis, point):
            columns.append(np.cross(axis[:, None], tips - point[:, None]).reshape(n, -1))

        def shift(axis):
            columns.append(np.repeat(axis[:, None], k, 1).reshape(n, -1))

        zero = np.zeros((n, 3))
        for R, point in [(rotations[0], zero)] + list(zip(rotations[:-1], points)):
            for e in np.eye(3):
                turn(R @ e, point)
            for e in np.eye(3):
                shift(R @ e)
        for i in range(k):
            for e in np.eye(3):
                own = np.zeros((n, k, 3))
                own[:, i] = rotations[-1] @ e
                columns.append(own.reshape(n, -1))
        return np.stack(columns, 2)

    def moments(self, q, masses):
        """Moment of gravity at each joint in the frame before it: n × joints × 3."""
        rotations, points, tips, (R, t) = self.place(q)
        ends = points[1:] + [tips.mean(1)]
        result = np.zeros((len(q), self.joints, 3))
        for j in range(self.joints):
            for i in range(j, self.joints):
                centre = (points[i] + ends[i]) / 2
                result[:, j] += np.cross(centre - points[j], masses[i] * GRAVITY)
            result[:, j] = np.einsum("nba,nb->na", rotations[j], result[:, j])
        return result


def anthropomorphic(name, foot, upper, fore, elbow, wrist, height=0.0, targets=((0.1, 0, 0.05),), limits=None):
    """6R: foot offset, upper arm (along x at zero), forearm, elbow offset, flange beyond the wrist."""
    x = foot + upper
    w = x + fore
    joints = [("R", (0, 0, 1), (0, 0, height)), ("R", (0, 1, 0), (foot, 0, height)), ("R", (0, 1, 0), (x, 0, height)),
              ("R", (1, 0, 0), (x, 0, height + elbow)), ("R", (0, 1, 0), (w, 0, height + elbow)),
              ("R", (1, 0, 0), (w, 0, height + elbow))]
    tips = [(w + wrist + a, b, height + elbow + c) for a, b, c in targets]
    return Arm(name, joints, tips, np.deg2rad(limits or [(-150, 150), (-130, 0), (-60, 140), (-180, 180), (-115, 115),
                                                         (-180, 180)]))


def universal(name, d1, a2, a3, d4, d5, d6):
    joints = [("R", (0, 0, 1), (0, 0, 0)), ("R", (0, -1, 0), (0, 0, d1)), ("R", (0, -1, 0), (-a2, 0, d1)),
              ("R", (0, -1, 0), (-a2 - a3, 0, d1)), ("R", (0, 0, -1), (-a2 - a3, -d4, d1)),
              ("R", (0, -1, 0), (-a2 - a3, -d4, d1 - d5))]
    return Arm(name, joints, [(-a2 - a3 + 0.03, -d4 - d6 - 0.03, d1 - d5)],
               np.deg2rad([(-180, 180), (-170, -10), (-150, 150), (-180, 180), (-180, 180), (-180, 180)]))


def arms():
    """Ten kinds; lengths rounded from data sheets and URDFs. They stand for kinds, not for a maker's product."""
    three = ((0.28, -0.05, -0.09), (0.28, -0.05, 0.09), (0.28, 0.10, 0.0))
    seven = [("R", (0, 0, 1), (0, 0, 0)), ("R", (0, 1, 0), (0, 0, .333)), ("R", (0, 0, 1), (0, 0, .649)),
             ("R", (0, -1, 0), (.0825, 0, .649)), ("R", (0, 0, 1), (0, 0, 1.033)), ("R", (0, -1, 0), (0, 0, 1.033)),
             ("R", (0, 0, -1), (.088, 0, 1.033))]
    scara = [("R", (0, 0, 1), (0, 0, 0)), ("R", (0, 0, 1), (.35, 0, 0)), ("P", (0, 0, 1), (.65, 0, 0)),
             ("R", (0, 0, 1), (.65, 0, 0))]
    gantry = [("P", (1, 0, 0), (0, 0, 0)), ("P", (0, 1, 0), (0, 0, 0)), ("P", (0, 0, 1), (0, 0, 0)),
              ("R", (0, 0, 1), (0, 0, 0)), ("R", (0, 1, 0), (0, 0, -.2))]
    rail = [("P", (0, 1, 0), (0, 0, 0)), ("R", (0, 0, 1), (0, 0, .5)), ("R", (0, 1, 0), (.3, 0, .7)),
            ("R", (0, 1, 0), (.3, 0, 1.4)), ("R", (1, 0, 0), (.3, 0, 1.5)), ("R", (0, 1, 0), (1.1, 0, 1.5)),
            ("R", (1, 0, 0), (1.1, 0, 1.5))]
    positioner = [("R", (1, 0, 0), (0, 0, 0)), ("R", (0, 0, 1), (0, 0, .2))]
    return [
        universal("small cobot", .089, .425, .392, .109, .095, .082),
        universal("large cobot", .128, .612, .572, .164, .116, .092),
        anthropomorphic("table-top 6R", 0, .27, .302, .07, .072, .29),
        anthropomorphic("precise 6R", .05, .425, .425, 0, .1, .478),
        anthropomorphic("6R of 165 kg", .312, 1.075, 1.28, .225, .215, .67, three),
        anthropomorphic("6R of 270 kg", .35, 1.25, 1.1, -.055, .23, .75, three),
        Arm("7R", seven, [(.13, .03, .86)], np.deg2rad([(-160, 160), (-95, 95), (-160, 160), (-170, -10), (-160, 160),
                                                        (0, 210), (-160, 160)])),
        Arm("SCARA", scara, [(.70, 0, -.1), (.62, .04, -.1)], [(-2.2, 2.2), (-2.4, 2.4), (-.2, 0), (-3.1, 3.1)]),
        Arm("gantry with wrist", gantry, [(.05, .02, -.4)], [(0, 2), (0, 1.5), (-.8, 0), (-3, 3), (-1.6, 1.6)]),
        Arm("6R on a rail", rail, [(1.4, .05, 1.55)], [(-1.5, 1.5), (-2.6, 2.6), (-.9, 1.1), (-1.1, 2.4), (-3.1, 3.1),
                                                        (-2, 2), (-3.1, 3.1)]),
        Arm("two-axis positioner", positioner, [(.3, 0, .3), (-.2, .25, .3), (-.1, -.3, .32)], [(-.6, .6), (-3.1, 3.1)]),
    ]


class Pool:
    """Configurations of an arm with J, n × rows × identifiable parameters, in units of the tolerances."""

    LENGTH, ANGLE = 1e-3, 2e-3

    def __init__(self, arm, count, rng, within=None):
        self.arm = arm
        low, high = arm.limits.T
        self.q = low + (high - low) * rng.random((count, arm.joints))
        self.time = rng.random(count)
        self.raw = arm.derivative(self.q)
        n, self.rows, columns = self.raw.shape
        unit = np.full(columns, self.LENGTH)
        for block in range(arm.joints + 1):
            unit[6 * block:6 * block + 3] = self.ANGLE
        if within is None:
            scaled = (self.raw * unit).reshape(-1, columns)
            _, s, Vt = np.linalg.svd(scaled, full_matrices=False)
            self.basis = unit[:, None] * Vt[:(s > 1e-7 * s[0]).sum()].T
        else:
            self.basis = within.basis
        self.J = self.raw @ self.basis
        angles = np.where(arm.sliding, np.pi * (self.q - low) / (high - low), self.q)
        self.f = np.hstack([np.cos(angles[:, ~arm.sliding]), np.sin(angles[:, ~arm.sliding]), angles[:, arm.sliding]])

    def along(self, j):
        """Displacements of the targets by a unit of joint j."""
        first = (9 if self.arm.sliding[j] else 6) + 6 * j
        return self.raw[:, :, first:first + 3] @ self.arm.w[j]

    @property
    def parameters(self):
        return self.J.shape[2]

    @property
    def smallest(self):
        return -(-self.parameters // self.rows)


def parts(pools, rng):
    """Each effect of one robot on each pool: name -> list of n × rows displacements."""
    arm = pools[0].arm
    J = arm.joints
    masses = 10.0 ** np.linspace(0, -1.2, J) * np.exp(rng.normal(0, .3, J))
    size, phase = rng.normal(size=(9, J)), rng.uniform(0, 2 * np.pi, (9, J))
    across = rng.normal(size=(J, 3))
    cycles = rng.integers(2, 9, J)
    smooth = 10 ** rng.uniform(np.log10(np.deg2rad(20)), np.log10(np.deg2rad(120)))
    frequency = rng.normal(size=(len(pools[0].f[0]), 300)) / smooth
    wave, weight = rng.uniform(0, 2 * np.pi, 300), rng.normal(size=(300, 3))
    result = {name: [] for name in CATALOGUE}
    for pool in pools:
        def moved(j, vector):
            """Turn by `vector` (n × 3, frame of joint j)."""
            return np.einsum("nrk,nk->nr", pool.raw[:, :, 6 + 6 * j:9 + 6 * j], vector)

        def slid(j, vector):
            return np.einsum("nrk,nk->nr", pool.raw[:, :, 9 + 6 * j:12 + 6 * j], vector)

        def along(j, amount):
            return (slid if arm.sliding[j] else moved)(j, amount[:, None] * arm.w[j])

        moment = arm.moments(pool.q, masses)
        own = np.einsum("njk,jk->nj", moment, arm.w)
        angle = np.where(arm.sliding, 2 * np.pi * pool.q / np.ptp(arm.limits, axis=1), pool.q)
        weak = np.exp(size / 2)
        joints = range(J)
        result["joint compliance"].append(sum(along(j, weak[0, j] * 10 ** (j / 4) * own[:, j]) for j in joints
                                              if not arm.sliding[j]) + 0 * moved(0, moment[:, 0]))
        result["link compliance"].append(sum(moved(j, weak[1, j] * 10 ** (j / 4) *
                                                   (moment[:, j] - own[:, j, None] * arm.w[j])) for j in joints))
        result["eccentricity"].append(sum(along(j, size[2, j] * np.sin(angle[:, j] + phase[2, j])) for j in joints))
        result["gear"].append(sum(along(j, size[3, j] * np.sin(cycles[j] * angle[:, j] + phase[3, j])) for j in joints))
        result["coupling"].append(sum(along(j, size[4, j] * angle[:, j - 1]) for j in joints if j > 0))
        result["backlash"].append(sum(along(j, abs(size[5, j]) * np.sign(own[:, j])) for j in joints))
        result["bearing"].append(sum(moved(j, np.sin(angle[:, j] + phase[6, j])[:, None] * across[j]) +
                                     moved(j, np.cos(2 * angle[:, j] + phase[7, j])[:, None] * across[(j + 1) % J])
                                     for j in joints))
        warm = 1 - np.exp(-3 * pool.time)
        result["temperature"].append(sum(slid(j, size[8, j] * warm[:, None] * across[j]) for j in joints))
        result["smooth"].append(np.tile(np.cos(pool.f @ frequency + wave) @ weight, (1, pool.rows // 3)))
    return result


def left_after_fit(pool, displacement):
    """RMS along an axis of what the geometric parameters do not take up."""
    J = pool.J.reshape(-1, pool.parameters)
    y = displacement.reshape(-1)
    return np.sqrt(np.mean((y - J @ np.linalg.lstsq(J, y, rcond=None)[0]) ** 2))


def effect(pools, rng):
    """One robot's effects on each pool, with an RMS of one along an axis after the geometric fit of the first pool."""
    every = parts(pools, rng)
    total = [np.zeros(p.J.shape[:2]) for p in pools]
    for name, (share, weight) in CATALOGUE.items():
        present, factor = rng.random() < share, weight * np.exp(rng.normal(0, .5))
        unit = left_after_fit(pools[0], every[name][0])
        overall = np.sqrt(np.mean(every[name][0] ** 2))
        if not present or not unit > 1e-6 * overall > 0:
            continue
        for sum_, part in zip(total, every[name]):
            sum_ += factor / max(unit, 0.05 * overall) * part
    unit = left_after_fit(pools[0], total[0])
    return [t / unit for t in total]
