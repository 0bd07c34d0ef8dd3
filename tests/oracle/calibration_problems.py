"""Random arms to calibrate: problem file, a true robot, poses, readings with noise of our own drawing, and the CSV of them."""
import numpy as np
import yaml

from statistics_by_definition import Poses, default_tolerance

FRAMES = ["x", "y", "z", "rx", "ry", "rz"]


def random_urdf(random, joints, base=0):
    """Joints j1 … jN; joint `base` + 1 hangs on the root beside the first `base` ones."""
    numbers = lambda values: " ".join(f"{v:.6f}" for v in values)
    text = '<robot name="random"><link name="l0"/>'
    for k in range(1, joints + 1):
        text += (f'<link name="l{k}"/><joint name="j{k}" type="revolute"><parent link="l{0 if k == base + 1 else k - 1}"/><child link="l{k}"/>'
                 f'<origin xyz="{numbers(random.uniform(-0.6, 0.6, 3))}" rpy="{numbers(random.uniform(-3, 3, 3))}"/>'
                 f'<axis xyz="{numbers(random.normal(size=3))}"/><limit lower="-2" upper="2.5" effort="0" velocity="1"/></joint>')
    return text + "</robot>"


def length(random, low, high):
    return f"{random.uniform(low, high):.4f} mm"


def random_device(random):
    kind = ["isotropic", "diagonal", "covariance", "photogrammetry", "laser_tracker"][random.integers(5)]
    if kind == "covariance":
        A = random.normal(size=(3, 3)) * 5e-5 + 3e-5 * np.eye(3)
        return {"type": kind, "matrix": [[float(v) for v in row] for row in A @ A.T + 1e-10 * np.eye(3)]}
    if kind == "laser_tracker":
        return {"type": kind, "noise": {"range": length(random, 0.005, 0.02), "range_per_m": length(random, 0.001, 0.02),
                                        "transverse": length(random, 0.02, 0.1), "angle": f"{random.uniform(0.001, 0.05):.5f} mrad"}}
    one = kind == "photogrammetry" or (kind == "isotropic" and random.random() < 0.5)
    return {"type": kind, "noise": length(random, 0.02, 0.2) if one else [length(random, 0.02, 0.2) for _ in range(3)]}


def random_placement(random, reach):
    return {"position": [float(f"{v:.4f}") for v in random.uniform(-reach, reach, 3)],
            "rpy": [float(f"{v:.4f}") for v in random.uniform(-1.4, 1.4, 3)]}


def random_problem(folder, random, joints=None, edit=None):
    joints = joints or int(random.integers(2, 7))
    # An arm of five joints goes up two and down three.
    base = 2 if joints == 5 else 0
    (folder / "arm.urdf").write_text(random_urdf(random, joints, base))
    targets = {f"T{k}": [float(f"{v:.4f}") for v in random.uniform(-0.3, 0.3, 3)] for k in range(random.integers(1, 5))}
    robot = {"urdf": "arm.urdf", "base": f"l{base}", "tip": f"l{joints}"}
    measurement = {"type": "points", "targets": targets, "repeats": int(random.integers(1, 4)), "device": random_device(random)}
    if measurement["device"]["type"] == "laser_tracker" or random.random() < 0.3:
        robot["placement"] = random_placement(random, 1)
        robot["placement"]["position"][0] += 4
    if random.random() < 0.3:
        measurement["device"]["stations"] = {f"S{k}": random_placement(random, 3) for k in range(random.integers(1, 3))}
    # A robot that stands off at a visit and joints that err: two of three arms have the one, half the other.
    if random.random() < 2 / 3:
        measurement["repeatability"] = {"position": length(random, 0.01, 0.2), "rotation": f"{random.uniform(0, 0.2):.4f} mrad"}
    if random.random() < 0.5:
        robot["encoder_noise"] = f"{random.uniform(0.01, 0.2):.4f} mrad"
    if edit:
        edit(robot, measurement)
    problem = {"posewright": 1, "robot": robot, "measurement": measurement, "variants": {"fitted": random_variant(random, joints, base)},
               "design": {"poses": 9}}
    (folder / "problem.yaml").write_text(yaml.safe_dump(problem))


def random_variant(random, joints, base):
    nuisance = ["base.*", "target.*"] if random.random() < 0.7 else ["base.*"]
    if random.random() < 0.5:
        variant = {"parameters": "auto", "nuisance": nuisance}
    else:
        # Some columns that a generic arm can tell apart; the base takes what the first joint's frame, or the offset of
        # one that is passed backward, would.
        names = [f"j{k}.{a}" for k in range(2, joints + 1) for a in FRAMES + ["offset", "gear"] if random.random() < 0.4]
        names = [name for name in names if name != f"j{base}.offset"]
        variant = {"parameters": names or ["j2.offset"], "nuisance": nuisance}
    if random.random() < 0.5:
        tolerance = {"*.offset": f"{random.uniform(0.02, 0.2):.3f} deg", "j2.x": "0.2 mm"}
        # A stated tolerance counts for base and targets, too.
        if random.random() < 0.5:
            tolerance |= {"base.?": "3 mm", "base.r?": "0.3 deg"}
        if random.random() < 0.5:
            tolerance["target.*"] = "0.4 mm"
        variant["tolerance"] = tolerance
    return variant


def drawn_truth(arm, random):
    """A robot that is off in every frame, offset, base and target by its tolerance."""
    names = [f"{name}.{a}" for name in arm.joints for a in FRAMES + ["offset"]] + [f"base.{a}" for a in FRAMES]
    names += [f"target.{c}" for c in arm.columns]
    return {name: default_tolerance(name) * random.normal() for name in names}


def drawn_poses(arm, random, count):
    limits = {j: (-2.0, 2.5) for j in arm.joints}
    Q = np.array([[random.uniform(*limits[j]) for j in arm.joints] for _ in range(count)])
    return Poses(Q, [list(arm.stations)[random.integers(len(arm.stations))] for _ in Q] if arm.stations else None)


def drawn_readings(arm, poses, truth, lines, random, larger=1.0, hidden_shift=0.0, independent=False):
    """lines[i] readings of pose i: the instrument's noise on every line, what stays at a visit once a pose.

    `larger`: than stated. `hidden_shift`: one more displacement of the tip that nobody states. `independent`: what
    stays at a visit is drawn anew for every reading, with the size that is stated for what is common."""
    exact, single, stays = arm.readings(poses, truth), arm.instrument(poses, truth), arm.stays(poses, truth)
    everything = []
    for i in range(len(poses.Q)):
        common = larger * stays[i] @ random.normal(size=stays[i].shape[1])
        if independent:
            common = larger * np.linalg.norm(stays[i], axis=1) * random.normal(size=len(exact[i]))
        common += np.tile(random.normal(size=3) * hidden_shift, len(arm.targets))
        for _ in range(lines[i]):
            noise = np.concatenate([np.linalg.cholesky(V) @ random.normal(size=3) for V in single[i]]) * larger
            everything.append((i, exact[i] + common + noise))
    return everything


def drop_cells(everything, random, share):
    """Empty cells here and there; something of every line is read."""
    empty = [random.random(len(z)) < share for _, z in everything]
    return [(i, np.where(gone & ~gone.all(), np.nan, z)) for gone, (i, z) in zip(empty, everything)]


def written(path, arm, poses, everything, random):
    """The file of readings; units in brackets for half of the files, SI otherwise."""
    in_mm = random.random() < 0.5
    head = [f"{j} [rad]" if in_mm else j for j in arm.joints] + (["station"] if arm.stations else [])
    head += [f"{c} [mm]" if in_mm else c for c in arm.columns]
    text = ",".join(["id"] + head) + "\n"
    for i, z in everything:
        cells = [repr(float(q)) for q in poses.Q[i]] + ([poses.stations[i]] if arm.stations else [])
        cells += ["" if np.isnan(v) else repr(float(v * 1000 if in_mm else v)) for v in z]
        text += ",".join([str(i + 1)] + cells) + "\n"
    path.write_text(text)


def averaged(arm, poses, everything):
    """What a calibration sees: means over the lines of a pose, and over which lines two readings are averaged together."""
    size = len(arm.columns)
    z, shares = np.full((len(poses.Q), size), np.nan), np.zeros((len(poses.Q), size, size))
    for i in range(len(poses.Q)):
        lines = np.array([line for k, line in everything if k == i])
        there = ~np.isnan(lines)
        n = there.sum(axis=0)
        z[i, n > 0] = np.nanmean(lines[:, n > 0], axis=0)
        both = there.T.astype(float) @ there
        shares[i] = both / np.maximum(np.outer(n, n), 1)
    return Poses(poses.Q, poses.stations, shares), z
