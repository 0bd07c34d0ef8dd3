"""Robots of every kind go the whole way, with a known truth: end_to_end.py PROGRAM [all [SEED [COUNT]] | ROBOT/INSTRUMENT …].

A robot is made from a seed, its truth too: every joint's frame and zero is off by up to a few tenths of a millimetre and milliradian. numpy reads it where
`plan` sends it and at ten poses more, and every command has its turn. Whether the calibrated robot is the true one the ten poses show: their errors are as large
as its intervals and the noise say. Without words a sample, in a minute; `all`: each kind with each instrument, COUNT seeds of it.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import numpy as np

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SAMPLE = ["lift_arm/points", "scara/pose", "mixed_4/tracker", "arm_6/plane", "arm_6/level"]
TURN, SLIDE = "revolute", "prismatic"
TARGETS = {"P1": [0.06, 0.01, 0.03], "P2": [-0.04, 0.07, 0.05], "P3": [0.01, -0.06, 0.09]}


# ---- robots: joints from base to tip, and what moves beside them

def joint(of, at, axis, low, high, mimic=None, beside=False):
    return {"of": of, "at": np.array(at, float), "rpy": np.zeros(3), "axis": np.array(axis, float), "range": (low, high), "mimic": mimic, "beside": beside}


def arm(axes=6, reach=1.0):
    axis = [(0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0)]
    at = [(0, 0, 0.3), (0.1, 0, 0.2), (0, 0, 0.5), (0.2, 0, 0.1), (0.35, 0, 0), (0.1, 0, 0), (0.15, 0, 0)]
    return [joint(TURN, np.array(a) * reach, e, -2, 2) for a, e in zip(at[:axes], axis[:axes])]


def rail(length=2.0, axis=(0, 1, 0)):
    return joint(SLIDE, (0, 0, 0.2), axis, 0, length)


def mixed(random, axes):
    """Turning and sliding joints in any order; two that turn at least where there are two."""
    kinds = [TURN] * min(2, axes) + [str(random.choice([TURN, TURN, SLIDE])) for _ in range(axes - 2)]
    joints = []
    for of in random.permutation(kinds):
        axis = random.normal(size=3)
        joints.append(joint(str(of), random.uniform(-0.3, 0.3, 3), axis / np.linalg.norm(axis), *((-1.8, 1.8) if of == TURN else (0, 0.5))))
    return joints


def palletiser(_):
    """A parallelogram keeps the hand level: the fourth joint undoes the second and the third."""
    joints = arm(3) + [joint(TURN, (0.4, 0, 0), (0, 1, 0), -2, 2, (1, -1.0, 0)), joint(TURN, (0.1, 0, 0), (0, 0, 1), -3, 3)]
    return joints


def lift_arm(_):
    """The second stage of the lift follows a motor that is not between base and tip."""
    motor = joint(SLIDE, (0.3, 0, 0), (0, 0, 1), 0, 0.5, beside=True)
    return [motor, joint(SLIDE, (0, 0, 0.5), (0, 0, 1), -1, 1, (0, 0.8, 0.02))] + arm(5)


ARMS = {
    "one_joint": lambda random: [joint(TURN, (0, 0, 0.3), (0, 0, 1), -2.5, 2.5)],
    "planar": lambda random: [joint(TURN, (x, 0, 0.1), (0, 0, 1), -2, 2) for x in (0, 0.5, 0.4)],
    "scara": lambda random: [joint(TURN, (0, 0, 0.3), (0, 0, 1), -2, 2), joint(TURN, (0.4, 0, 0), (0, 0, 1), -2, 2), joint(SLIDE, (0.35, 0, 0), (0, 0, 1), -0.2, 0), joint(TURN, (0, 0, -0.1), (0, 0, 1), -3, 3)],
    "gantry": lambda random: [rail(2.0, e) for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1))] + [joint(TURN, (0, 0, -0.2), (0, 0, 1), -3, 3), joint(TURN, (0, 0, -0.1), (1, 0, 0), -2, 2)],
    "rail_arm": lambda random: [rail()] + arm(),
    "palletiser": palletiser,
    "lift_arm": lift_arm,
    "arm_4": lambda random: arm(4), "arm_5": lambda random: arm(5), "arm_6": lambda random: arm(6), "arm_7": lambda random: arm(7),
    **{f"mixed_{n}": lambda random, n=n: mixed(random, n) for n in range(2, 9)},
}


class Arm:
    zeros, workspace = "*.offset", []
    text = "robot: {urdf: robot.urdf, base: base, tip: tip}"

    def __init__(self, joints):
        self.joints, self.moving = joints, coordinates(joints)
        self.names, self.ranges = [f"j{k}" for k in self.moving], [joints[k]["range"] for k in self.moving]
        self.right = [[0.0] * 7 for _ in joints]

    def off(self, random):
        return [[*(2e-4 * random.normal(size=3)), *(3e-4 * random.normal(size=3)), (1e-3 if j["of"] == TURN else 3e-4) * random.normal()] for j in self.joints]

    def tip(self, q, error):
        return tip(self.joints, dict(zip(self.moving, q)), error)


def root(f, x):
    """Newton's method, the derivative by differences."""
    for _ in range(30):
        x = x - np.linalg.solve(np.array([(f(x + h) - f(x - h)) / 2e-6 for h in 1e-6 * np.eye(len(x))]).T, f(x))
    return x


class Platform:
    """Actuators stand where the nominal robot has them at a pose; the platform is where the true legs then close.

    A kind says `nominal` and `spread` (1σ) of its legs' values, what its loops miss (`loops`: platform, actuators, values → m),
    and where the platform's frame is (`frame`)."""
    right = 0.0

    def off(self, random):
        return self.spread * random.normal(size=self.nominal.shape)

    def tip(self, q, error):
        q = np.array(q)
        rho = root(lambda rho: self.loops(q, rho, self.nominal), np.zeros(len(self.nominal)))
        return self.frame(root(lambda x: self.loops(x, rho, self.nominal + error), q))


def speeds(legs, speed):
    return "motion: {velocity: {" + ", ".join(f"leg_{i}.rho: {speed}" for i in range(1, legs + 1)) + "}}"


class Hexapod(Platform):
    """Six legs of variable length. A value is a, b, and the length at which the actuator counts from zero."""
    text = ("robot: {model: gough, reference: {position: [0, 0, 0.42]}, actuators: {travel: [-0.06, 0.06]}, legs: ["
            + ", ".join(f'{{a: {{radius: 0.25, angle: "{a} deg"}}, b: {{radius: 0.15, angle: "{b} deg"}}, l: 0.45}}'
                        for a, b in zip((50, 130, 170, 250, 290, 370), (80, 100, 200, 220, 320, 340))) + "]}")
    names, ranges = ["x", "y", "z", "rx", "ry", "rz"], [(-0.05, 0.05)] * 2 + [(-0.03, 0.03)] + [(-0.15, 0.15)] * 3
    zeros, workspace = "*.l", ["pose: {" + ", ".join(f"{n}: [{low}, {high}]" for n, (low, high) in zip(names, ranges)) + "}", speeds(6, 0.1)]

    def __init__(self):
        on_circle = lambda radius, angle: [radius * np.cos(np.radians(angle)), radius * np.sin(np.radians(angle)), 0]
        self.nominal = np.array([[*on_circle(0.25, a), *on_circle(0.15, b), 0.45] for a, b in zip((50, 130, 170, 250, 290, 370), (80, 100, 200, 220, 320, 340))])
        self.spread = 3e-4

    def frame(self, x):
        return placed(np.array([0, 0, 0.42]) + x[:3], x[3:])

    def loops(self, x, rho, legs):
        X = self.frame(x)
        return legs[:, 6] + rho - np.linalg.norm(legs[:, 3:6] @ X[:3, :3].T + X[:3, 3] - legs[:, :3], axis=1)


class Delta(Platform):
    """Three arms that turn downwards. A value is base radius, platform radius, arm, forearm, zero and azimuth."""
    text = ("robot: {model: delta, base_radius: 0.2, platform_radius: 0.05, arm: 0.3, forearm: 0.7, "
            'travel: ["-40 deg", "80 deg"], range: {x: [-0.2, 0.2], y: [-0.2, 0.2], z: [-0.8, -0.6]}}')
    names, ranges = ["x", "y", "z"], [(-0.2, 0.2), (-0.2, 0.2), (-0.8, -0.6)]
    zeros, workspace = "*.offset", [speeds(3, 1)]

    def __init__(self):
        self.nominal = np.array([[0.2, 0.05, 0.3, 0.7, 0, azimuth] for azimuth in np.radians([0, 120, 240])])
        self.spread = np.array([3e-4, 3e-4, 3e-4, 3e-4, 1e-3, 5e-4])

    def frame(self, x):
        return placed(x, (0, 0, 0))

    def loops(self, x, rho, legs):
        base, platform, arm, forearm, zero, azimuth = legs.T
        outwards, below = np.array([np.cos(azimuth), np.sin(azimuth), 0 * azimuth]).T, rho + zero
        elbow = (base + arm * np.cos(below))[:, None] * outwards - (arm * np.sin(below))[:, None] * [0, 0, 1]
        return forearm - np.linalg.norm(x + platform[:, None] * outwards - elbow, axis=1)


ROBOTS = {**{name: lambda random, of=of: Arm(of(random)) for name, of in ARMS.items()}, "hexapod": lambda _: Hexapod(), "delta": lambda _: Delta()}


def turn(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def placed(at, rpy):
    T = np.eye(4)
    T[:3, :3] = turn((0, 0, 1), rpy[2]) @ turn((0, 1, 0), rpy[1]) @ turn((1, 0, 0), rpy[0])
    T[:3, 3] = at
    return T


def coordinates(joints):
    """Indices of the joints that are moved, as the program orders them."""
    return [k for k, j in enumerate(joints) if j["mimic"] is None]


def tip(joints, values, error):
    """@param values  by index of what is moved; error: a frame's x y z rx ry rz and a zero for each joint"""
    T = np.eye(4)
    for k, j in enumerate(joints):
        if j["beside"]:
            continue
        master, factor, constant = j["mimic"] or (k, 1.0, 0.0)
        q = factor * (values[master] + error[master][6]) + constant
        T = T @ placed(j["at"], j["rpy"]) @ placed(error[k][:3], error[k][3:6])
        T = T @ (placed((0, 0, 0), (0, 0, 0)) if j["of"] == SLIDE else np.block([[turn(j["axis"], q), np.zeros((3, 1))], [0, 0, 0, 1]]))
        T[:3, 3] += T[:3, :3] @ j["axis"] * (q if j["of"] == SLIDE else 0)
    return T @ placed((0, 0, 0.1), (0, 0, 0))


def urdf(joints):
    text, parent = '<robot name="made"><link name="base"/>', "base"
    for k, j in enumerate(joints):
        follow = f'<mimic joint="j{j["mimic"][0]}" multiplier="{j["mimic"][1]}" offset="{j["mimic"][2]}"/>' if j["mimic"] else ""
        low, high = j["range"]
        text += (f'<link name="l{k}"/><joint name="j{k}" type="{j["of"]}"><parent link="{parent}"/><child link="l{k}"/><origin xyz="{" ".join(map(repr, j["at"].tolist()))}"/>'
                 f'<axis xyz="{" ".join(map(repr, j["axis"].tolist()))}"/><limit lower="{low}" upper="{high}" effort="1" velocity="1"/>{follow}</joint>\n')
        parent = parent if j["beside"] else f"l{k}"
    return text + f'<link name="tip"/><joint name="end" type="fixed"><parent link="{parent}"/><child link="tip"/><origin xyz="0 0 0.1"/></joint></robot>\n'


# ---- instruments: their part of the problem file, and what they read of a tip

def points(device, noise):
    def read(T, random, moved, nominal):
        return {f"{name}.{axis}": value for name, p in TARGETS.items() for axis, value in zip("xyz", (moved @ T @ [*p, 1])[:3] + noise * random.normal(size=3))}
    return f"measurement: {{type: points, targets: {json.dumps(TARGETS)}, device: {device}}}", "target.*", read


def pose(position, rotation):
    def read(T, random, moved, nominal):
        X = moved @ T
        R = turn(*unit(rotation * random.normal(size=3))) @ X[:3, :3]
        numbers = [*(X[:3, 3] + position * random.normal(size=3)), *rotation_vector(R)]
        return dict(zip(("pose.x", "pose.y", "pose.z", "pose.rx", "pose.ry", "pose.rz"), numbers))
    return f'measurement: {{type: pose, device: {{type: isotropic, noise: {{position: {position}, rotation: {rotation}}}}}}}', "tool.*", read


def part_of_pose(position, rotation):
    """A height and two angles, as three gauges under a plate read them: the small rotation from where the hand should be."""
    def read(T, random, moved, nominal):
        X = moved @ T
        turned = rotation_vector(X[:3, :3] @ nominal[:3, :3].T)
        return {"pose.z": X[2, 3] + position * random.normal(), **{f"pose.r{axis}": turned[k] + rotation * random.normal() for k, axis in enumerate("xy")}}
    noise = f"{{position: {position}, rotation: {rotation}}}"
    return f"measurement: {{type: pose, components: [z, rx, ry], device: {{type: isotropic, noise: {noise}}}}}", "tool.*", read


def plane(noise):
    """A laser on the hand, whatever its direction, as if the plate were as large as the cell."""
    probe, point, normal = [0.05, 0.02, 0.1], [0.5, 0.2, -0.3], unit(np.array([0.2, -0.1, 1.0]))[0]

    def read(T, random, moved, nominal):
        return {"plane.distance": normal @ ((moved @ T @ [*probe, 1])[:3] - point) + noise * random.normal()}
    place = f"{{point: {point}, normal: {normal.tolist()}, radius: 20}}"
    return f"measurement: {{type: plane, probe: {probe}, plane: {place}, range: [-20, 20], device: {{type: isotropic, noise: {noise}}}}}", 'target.*", "plane.*', read


def level(noise):
    """A level that reads up to 80 degrees."""
    def read(T, random, moved, nominal):
        tilts = np.arcsin((moved @ T)[2, :2])
        if np.abs(tilts).max() > np.radians(80):
            return None
        return {f"inclination.{axis}": tilt + noise * random.normal() for axis, tilt in zip("xy", tilts)}
    return f"measurement: {{type: inclination, range: 80 deg, device: {{type: isotropic, noise: {noise}}}}}", "tool.*", read


def camera(noise):
    """A camera four metres away sees a board on the hand from any side, as if it were of glass."""
    at, rpy, focal, centre, spacing = (4, 0, 0.5), (-np.pi / 2, 0, np.pi / 2), 1500, (1280, 1024), 0.06
    points = np.array([[c * spacing, r * spacing, 0, 1] for r in range(3) for c in range(4)])

    def read(T, random, moved, nominal):
        p = np.linalg.inv(placed(at, rpy)) @ moved @ T @ points.T
        pixels = focal * p[:2] / p[2] + np.array([centre]).T + noise * random.normal(size=(2, len(points)))
        return {f"point_{i + 1}.{axis}": pixels[k, i] for i in range(len(points)) for k, axis in enumerate("uv")}
    return (f"measurement: {{type: camera, mount: fixed, camera: {{focal: {[focal] * 2}, centre: {list(centre)}, size: [2560, 2048], position: {list(at)}, rpy: {list(rpy)}}}, "
            f'board: {{rows: 3, columns: 4, spacing: {spacing}}}, device: {{type: isotropic, noise: {noise}}}}}'), "board.*", read


def unit(v):
    angle = np.linalg.norm(v)
    return v / angle, angle


def rotation_vector(R):
    angle = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    if angle < 1e-9:
        return np.zeros(3)
    if angle > 3.1:  # by the symmetric part
        w, V = np.linalg.eigh((R + R.T) / 2)
        axis = V[:, -1] * np.sign(V[:, -1] @ [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]] or 1)
        return axis * angle
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) * angle / (2 * np.sin(angle))


INSTRUMENTS = {
    "points": points("{type: isotropic, noise: 30 um}", 30e-6),
    "tracker": points("{type: laser_tracker, noise: {range: 20 um, transverse: 20 um}, stations: {A: [4, 0.5, 0.5]}}", 20e-6),
    "pose": pose(50e-6, 1e-4),
    "camera": camera(0.1),
    "part_of_pose": part_of_pose(30e-6, 1e-4),
    "plane": plane(20e-6),
    "level": level(1e-4),
}


# ---- the way

class Fault(Exception):
    pass


class Way:
    def __init__(self, robot, instrument, seed):
        self.random = np.random.default_rng([seed, *map(ord, robot + instrument)])
        self.robot = ROBOTS[robot](self.random)
        self.measurement, self.carried, self.read = INSTRUMENTS[instrument]
        self.tracker = instrument == "tracker"
        # One or two readings a pose tell less: too little without tolerances, and for weights that settle.
        self.few = instrument in ("plane", "level")
        self.poses = 60 if self.few else 30
        self.arm = isinstance(self.robot, Arm)
        # A camera shows how it is turned towards the one axis; other instruments show nothing but where they stand.
        self.alone = len(self.robot.names) == 1 and instrument != "camera" or (robot, instrument) == ("delta", "level")

    def run(self, *words, codes=(0,)):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=600)
        if done.returncode not in codes:
            raise Fault(f"{' '.join(map(str, words))}: exit {done.returncode}: {done.stderr.strip()[-300:]}")
        return done

    def go(self, folder):
        self.folder = pathlib.Path(folder)
        if self.arm:
            (self.folder / "robot.urdf").write_text(urdf(self.robot.joints))
            self.run("init", "robot.urdf", "--tip", "tip", "--tracker", "--yes", "-o", "by_init.yaml", codes=(0, 1))
        (self.folder / "problem.yaml").write_text(self.problem())
        self.run("observe", "problem.yaml", codes=(0, 1) if self.alone else (0,))
        done = self.run("plan", "problem.yaml", "--force", codes=(1,) if self.alone else (0,))
        if self.alone:
            return self.refused(done.stderr)
        self.run("evaluate", "problem.yaml", "plan.json")
        self.before()
        self.measure()
        calibration = self.calibrations()
        self.after()
        return calibration

    def refused(self, message):
        """Of one joint nothing is known beside where it stands, and one line says so."""
        if "no parameter of interest can be identified" not in message:
            raise Fault(f"plan: {message.strip()[-300:]}")
        return 1.0

    def problem(self):
        # What turns by less than a nominal joint's range keeps a parameter apart from the others; auto leaves out what none can tell.
        workspace = ["stations: {among: {A: [4, 0.5, 0.5], B: [2, 3, 1]}}"] * self.tracker + self.robot.workspace
        return (f"posewright: 1\n{self.robot.text}\n{self.measurement}\n" + (f"workspace: {{{', '.join(workspace)}}}\n" if workspace else "")
                + f'variants:\n  geometric: {{parameters: auto, nuisance: ["base.*", "{self.carried}"]}}\n  zeros: {{parameters: ["{self.robot.zeros}"], nuisance: ["base.*", "{self.carried}"]}}\n'
                f"design: {{poses: {self.poses}, candidates: 150, restarts: 1, method: exchange, test_poses: {{random: 20}}}}\n")

    def before(self):
        self.run("route", "plan.json", "--force")
        for form, file in (("csv", "poses_out.csv"), ("joint-trajectory", "trajectory.yaml") if self.arm else ("json", "poses_out.json")):
            self.run("export", "route.json", "--to", form, "-o", file, "--force")
        self.run("simulate", "problem.yaml", "plan.json", "--draws", "3", "--json")
        self.run("compare", "problem.yaml", "--variant", "geometric,zeros")
        if self.tracker:
            self.run("stations", "problem.yaml", "--full", "1")
        self.page("plan.json", "--brief")

    def page(self, *words):
        self.run("report", *words, "-o", "page.html", "--force")
        page = (self.folder / "page.html").read_text()
        if not (page.startswith("<!") and page.rstrip().endswith("</html>") and len(page) > 20000):
            raise Fault(f"report {words}: no page")

    def measure(self):
        plan = json.loads((self.folder / "plan.json").read_text())
        names, error = self.robot.names, self.robot.off(self.random)
        places = [[dict(zip(pose["names"], pose["configuration"]))[name] for name in names] for pose in plan["poses"]]
        fit = len(places)
        places += [[self.random.uniform(*of) for of in self.robot.ranges] for _ in range(10)]
        # The base is a centimetre from where the file has it.
        moved = placed(1e-2 * self.random.normal(size=3), 1e-2 * self.random.normal(size=3))
        station = np.linalg.inv(placed((4, 0.5, 0.5), (0, 0, 0))) if self.tracker else np.eye(4)
        rows = []
        for i, q in enumerate(places):
            T = self.robot.tip(q, error)
            read = self.read(T, self.random, station @ moved, self.robot.tip(q, self.robot.right))
            if read is not None:
                rows.append({"id": i + 1, **dict(zip(names, q)), **read, "use": "fit" if i < fit else "validate"})
        lines = [",".join(rows[0])] + [",".join(repr(float(v)) if not isinstance(v, (int, str)) else str(v) for v in row.values()) for row in rows]
        (self.folder / "measured.csv").write_text("\n".join(lines) + "\n")

    def calibrations(self):
        result = json.loads(self.run("calibrate", "problem.yaml", "measured.csv", "-o", "found.yaml", *(["--urdf", "found.urdf"] if self.arm else []), "--json").stdout)
        (self.folder / "calibration.json").write_text(json.dumps(result))
        for words in (("--no-prior",), ("--weights", "ols"), ("--weights", "robust"), ("--in-steps", "--profile", "none")):
            self.run("calibrate", "problem.yaml", "measured.csv", *words, codes=(0, 1) if self.few and words in (("--no-prior",), ("--weights", "robust")) else (0,))
        self.page("calibration.json")
        return self.judge(result)

    def judge(self, result):
        """Residuals are the noise, and the ten poses err as the intervals of the estimate and the noise say; of pictures, as those that were fitted."""
        slack = max(1.25, 1 + 4 / np.sqrt(2 * result["freedom"]))
        if not 1 / slack < result["noise_scale"] < slack:
            raise Fault(f"residuals are {result['noise_scale']:.2f} times the noise")
        judged = [pose["accuracy"] for pose in result["poses"] if pose["held_back"]]
        if judged[0]["observed"]["position"] is None:  # pixels tell no place
            rms = {r["poses"]: r["rms"] for r in result["residuals"] if r["parameters"] == "calibrated"}
            size = rms["held back"] / rms["fitted"]
        else:
            size = np.sqrt(np.mean([(a["observed"]["position"] / a["with_noise"]["position"])**2 for a in judged]))
        if not 0.5 < size < 1.6:
            raise Fault(f"poses that were not fitted err {size:.2f} times as far as predicted")
        return size

    def after(self):
        self.run("observe", "problem.yaml", "--parameters", "found.yaml")
        # An arm that cannot turn its tip any way cannot make every error good: one line says so.
        self.run("compensate", "found.yaml", "poses_out.csv", "-o", "corrected.csv", codes=(0, 1))
        # Of one joint no known parameter moves the tip: no pose is worth more than another, and one line says so.
        self.run("next", "problem.yaml", "--data", "measured.csv", "--candidates", "100", "--state", "-", codes=(0, 1) if len(self.robot.names) == 1 else (0,))


def check(name, seed=1):
    robot, instrument = name.split("/")
    begin, fault, size = time.monotonic(), None, float("nan")
    with tempfile.TemporaryDirectory() as folder:
        try:
            size = Way(robot, instrument, seed).go(folder)
        except (Fault, subprocess.TimeoutExpired, KeyError, ValueError) as error:
            fault = re.sub(r"\s+", " ", f"{type(error).__name__}: {error}")
    print(f"{name:22} {seed:3} {time.monotonic() - begin:5.1f} s  {f'predicted errors times {size:.2f}' if fault is None else fault}", flush=True)
    return fault is None


def main(words):
    if words[:1] == ["all"]:
        first, count = (int(words[1]) if len(words) > 1 else 1), (int(words[2]) if len(words) > 2 else 1)
        ways = [(f"{robot}/{instrument}", seed) for seed in range(first, first + count) for robot in ROBOTS for instrument in INSTRUMENTS]
    else:
        ways = [(name, 1) for name in words or SAMPLE]
    good = sum(check(*way) for way in ways)
    print(f"{good} of {len(ways)} went the whole way")
    return 0 if good == len(ways) else 1


sys.exit(main(sys.argv[2:]))
