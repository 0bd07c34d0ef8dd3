"""What a written plan of a rigid arm states, computed again from its poses alone: plan_of_an_arm.py PROGRAM SOURCE [COUNT [SEED]].

A second road that knows only definitions: forward kinematics multiplied out, derivatives by differences, the information
as a sum, σ from its inverse, O1 to O5 from singular values. Nothing here is taken from the program but the files that it
writes. COUNT random arms (8) beside the KUKA KR 270 of the examples."""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

try:
    import numpy as np
    import yaml
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml)")
    sys.exit(77)

UNITS = {"mm": 1e-3, "um": 1e-6, "m": 1.0, "deg": np.pi / 180, "mrad": 1e-3, "rad": 1.0}


def si(value):
    if not isinstance(value, str):
        return float(value)
    number, unit = value.split()
    return float(number) * UNITS[unit]


def rotation(axis, angle):
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def frame(xyz=(0, 0, 0), R=np.eye(3)):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R, xyz
    return X


def rpy(r, p, y):
    return rotation((0, 0, 1), y) @ rotation((0, 1, 0), p) @ rotation((1, 0, 0), r)


def displaced(values):
    """A small displacement (x, y, z, rx, ry, rz) of a frame, in its own axes."""
    return frame(values[:3], rpy(*values[3:]))


def joints_of(urdf, tip):
    """From the base to the tip: name, frame in its parent, axis (None where it is fixed)."""
    by_child = {j.find("child").get("link"): j for j in xml.etree.ElementTree.parse(urdf).getroot().iter("joint")}
    chain = []
    while tip in by_child:
        joint = by_child[tip]
        origin, axis = joint.find("origin"), joint.find("axis")
        numbers = {key: [float(x) for x in ((origin.get(key) if origin is not None else None) or "0 0 0").split()] for key in ("xyz", "rpy")}
        moves = joint.get("type") != "fixed"
        chain.insert(0, (joint.get("name"), frame(numbers["xyz"], rpy(*numbers["rpy"])),
                         [float(x) for x in axis.get("xyz").split()] if moves else None))
        tip = joint.find("parent").get("link")
    return chain


AXES = ["x", "y", "z", "rx", "ry", "rz"]


def readings(chain, targets, q, change, off=np.zeros(6)):
    """Positions of all targets; `change`: parameter name → what it differs by from its nominal value; `off`: how far the
    tip stands off, a translation and a rotation about itself in the axes of the measurement frame."""
    of = lambda name: [change.get(f"{name}.{axis}", 0.0) for axis in AXES]
    X, k = displaced(of("base")), 0
    for name, X_ParentJoint, axis in chain:
        X = X @ X_ParentJoint @ displaced(of(name))
        if axis is None:
            continue
        gear = 1 + change.get(f"{name}.gear", 0.0)
        X = X @ frame(R=rotation(axis, q[k] * gear + change.get(f"{name}.offset", 0.0)))
        k += 1
    X = X @ displaced(of("tool"))
    X[:3, 3] += off[:3]
    if np.any(off[3:]):
        X[:3, :3] = rotation(off[3:], np.linalg.norm(off[3:])) @ X[:3, :3]
    points = [np.append(p + [change.get(f"target.{n}.{a}", 0.0) for a in "xyz"], 1) for n, p in targets.items()]
    return np.concatenate([(X @ p)[:3] for p in points])


def derivative(f, size, h=1e-5):
    """Central differences of f by each of its `size` arguments."""
    return np.array([(f(h * e) - f(-h * e)) / (2 * h) for e in np.eye(size)]).T


def covariance_at(problem, chain, targets, q):
    """Of all readings at q: the instrument's over the repeats; one displacement of the tip, common to all; the joints'."""
    measurement = problem["measurement"]
    noise = si(measurement["device"]["noise"]) / np.sqrt(measurement.get("repeats", 1))
    V = noise**2 * np.eye(3 * len(targets))
    stays = measurement.get("repeatability", 0)
    stays = stays if isinstance(stays, dict) else {"position": stays}
    size = np.repeat([si(stays["position"]), si(stays.get("rotation", 0))], 3)
    A = derivative(lambda off: readings(chain, targets, q, {}, off), 6) * size
    J = derivative(lambda step: readings(chain, targets, np.add(q, step), {}), len(q)) * si(problem["robot"].get("encoder_noise", 0))
    return V + A @ A.T + J @ J.T


def check(problem_file, plan_file):
    problem, plan = yaml.safe_load(problem_file.read_text()), json.loads(plan_file.read_text())
    own = problem["robot"].get("parameter_names", {})
    chain = joints_of(problem_file.parent / problem["robot"]["urdf"], problem["robot"]["tip"])
    measurement = problem["measurement"]
    targets = {n: np.array([si(v) for v in p]) for n, p in measurement["targets"].items()}
    used = [p for p in plan["parameters"] if p["identifiable"]]
    G = []
    for pose in plan["poses"]:
        q, columns = pose["configuration"], []
        for p in used:
            name, h = own.get(p["name"], p["name"]), 1e-5
            columns.append((readings(chain, targets, q, {name: h}) - readings(chain, targets, q, {name: -h})) / (2 * h))
        G.append(np.linalg.solve(np.linalg.cholesky(covariance_at(problem, chain, targets, q)), np.array(columns).T))
    G = np.vstack(G)
    scale = np.array([p["tolerance"] for p in used])
    interest = np.array([p["role"] == "interest" for p in used])
    # In units of the tolerances, so that a plain inverse is safe.
    covariance = np.linalg.inv((G * scale).T @ (G * scale))
    sigma = np.sqrt(np.diag(covariance)) * scale
    stated = np.array([p["sigma"] for p in used])
    worst = np.max(np.abs(sigma / stated - 1))
    schur = np.linalg.inv(covariance[np.ix_(interest, interest)])
    log_det = np.linalg.slogdet(schur)[1] - 2 * np.log(scale[interest]).sum()
    s = np.sqrt(np.linalg.eigvalsh(schur))[::-1]
    indices = {"o1": np.exp(np.log(s).mean()) / np.sqrt(len(plan["poses"])), "o2": s[-1] / s[0], "o3": s[-1],
               "o4": s[-1] ** 2 / s[0], "o5": 1 / (1 / s).sum()}
    criterion = plan["criterion"]
    off = max(abs(indices[name] / criterion["indices"][name] - 1) for name in indices)
    good = worst < 1e-7 and abs(log_det - criterion["log_det"]) < 1e-6 and off < 1e-7
    print(f"{problem_file.parent.name}: {len(used)} parameters, σ differ by {worst:.1e}, log det by "
          f"{abs(log_det - criterion['log_det']):.1e}, indices by {off:.1e}{'' if good else '  FAILED'}")
    return good


def random_arm(folder, random):
    numbers = lambda values: " ".join(f"{v:.6f}" for v in values)
    text = '<robot name="random"><link name="l0"/>'
    for k in range(1, 7):
        text += (f'<link name="l{k}"/><joint name="j{k}" type="revolute"><parent link="l{k - 1}"/><child link="l{k}"/>'
                 f'<origin xyz="{numbers(random.uniform(-0.6, 0.6, 3))}" rpy="{numbers(random.uniform(-3, 3, 3))}"/>'
                 f'<axis xyz="{numbers(random.normal(size=3))}"/><limit lower="-2" upper="2.5" effort="0" velocity="1"/></joint>')
    (folder / "arm.urdf").write_text(text + "</robot>")
    targets = {f"T{k}": [float(f"{v:.4f}") for v in random.uniform(-0.3, 0.3, 3)] for k in range(3)}
    problem = {"posewright": 1, "robot": {"urdf": "arm.urdf", "base": "l0", "tip": "l6"},
               "measurement": {"type": "points", "targets": targets, "repeats": int(random.integers(1, 4)),
                               "device": {"type": "isotropic", "noise": f"{random.uniform(0.02, 0.2):.3f} mm"}},
               "variants": {"all": {"parameters": "auto", "nuisance": ["base.*", "target.*"]}},
               "design": {"poses": 9}}
    # A robot that stands off at a visit and joints that err: two of three arms have the one, half the other.
    if random.random() < 2 / 3:
        problem["measurement"]["repeatability"] = {"position": f"{random.uniform(0.01, 0.2):.3f} mm",
                                                   "rotation": f"{random.uniform(0, 0.2):.3f} mrad"}
    if random.random() < 0.5:
        problem["robot"]["encoder_noise"] = f"{random.uniform(0.01, 0.2):.3f} mrad"
    (folder / "problem.yaml").write_text(yaml.safe_dump(problem))


def main(program, source, count="8", seed="1"):
    program, good = pathlib.Path(program).resolve(), True
    with tempfile.TemporaryDirectory() as name:
        cases = [pathlib.Path(source).resolve() / "examples/kr270"]
        for k in range(int(count)):
            cases.append(pathlib.Path(name) / f"arm_{seed}_{k}")
            cases[-1].mkdir()
            random_arm(cases[-1], np.random.default_rng([int(seed), k]))
        for case in cases:
            plan = pathlib.Path(name) / "plan.json"
            subprocess.run([program, "plan", case / "problem.yaml", "--candidates", "24", "--restarts", "1", "--method", "exchange",
                            "-o", plan, "--poses-csv", "-", "--force", "--quiet"], check=True, stdout=subprocess.DEVNULL)
            good = check(case / "problem.yaml", plan) and good
    sys.exit(0 if good else 1)


main(*sys.argv[1:])
