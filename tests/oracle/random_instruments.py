"""Random instruments that can see a random robot: `measurement` of a problem file without what stays at a pose."""
import numpy as np

from random_robots import rounded


def chance(random, share):
    return random.random() < share


def pick(random, choices):
    return choices[random.integers(len(choices))]


def amount(random, low, high, unit):
    return f"{random.uniform(low, high):.4f} {unit}"


def targets(random, count, size):
    return {f"T{k}": rounded(random, size) for k in range(1, count + 1)}


def covariance(random, sizes):
    root = np.diag(sizes) @ random.uniform(-1, 1, (len(sizes), len(sizes)))
    return (root @ root.T + 1e-10 * np.eye(len(sizes))).tolist()


def point_noise(random):
    kind = pick(random, ["isotropic", "isotropic", "diagonal", "covariance", "photogrammetry", "laser_tracker", "laser_tracker"])
    if kind == "covariance":
        return {"type": kind, "matrix": covariance(random, [1e-4, 5e-5, 2e-5])}
    if kind == "laser_tracker":
        noise = {"range": amount(random, 2, 20, "um"), "range_per_m": amount(random, 0.1, 5, "um"),
                 "transverse": amount(random, 1, 20, "um"), "angle": amount(random, 1, 20, "urad")}
        return {"type": kind} | pick(random, [{}, {"noise": noise}, {"noise": {"range": "10 um", "angle": "5 urad"}}])
    listed = kind == "diagonal" or kind == "isotropic" and chance(random, 0.3)
    return {"type": kind, "noise": [amount(random, 0.01, 0.1, "mm") for _ in range(3)] if listed else amount(random, 0.01, 0.1, "mm")}


def point_device(random, size):
    """Noise of points and where the instrument stands, some sizes of the robot away."""
    device, stations = point_noise(random), {}
    for name in ["A", "B", "C"][:random.integers(0, 3)]:
        place = (random.choice([-1, 1], 3) * random.uniform(2 * size, 4 * size, 3)).round(3).tolist()
        stations[name] = {"position": place, "rpy": rounded(random, 3)} if chance(random, 0.7) else place
    if device["type"] == "laser_tracker" and not stations:
        stations = {"A": [4 * size, size, 0.5 * size]}
    return device | ({"stations": stations} if stations else {})


def points(random, robot):
    count = int(random.integers(1, 5))
    measurement = {"type": "points", "targets": targets(random, count, 0.5 * robot.size), "device": point_device(random, robot.size)}
    if count == 1 and chance(random, 0.5):
        measurement = {"type": "position", "target": rounded(random, 0.5 * robot.size), "device": measurement["device"]}
    if chance(random, 0.25):
        measurement["components"] = pick(random, [["x", "y"], ["z", "x"], ["y"], ["y", "z"]])
    return measurement


def pins(random, robot):
    """Both markers from where the measurement frame is."""
    measured = {"type": "points", "targets": {"P0": [0, 0, 0], "P1": [0, 0, 0]}, "repeats": int(random.integers(1, 4))}
    return measured | {"device": pick(random, [{"type": "isotropic", "noise": "0.1 mm"}, {"type": "diagonal", "noise": [1e-4, 5e-5, 2e-5]},
                                               {"type": "covariance", "matrix": covariance(random, [1e-4, 5e-5, 2e-5])}])}


def pose(random, robot):
    kind = pick(random, ["isotropic", "covariance", "photogrammetry"])
    device = {"type": kind}
    if kind == "isotropic":
        device["noise"] = {"position": amount(random, 0.01, 0.1, "mm"), "rotation": amount(random, 0.01, 0.5, "mrad")}
    elif kind == "covariance":
        device["matrix"] = covariance(random, [1e-4] * 3 + [3e-4] * 3)
    else:
        device |= {"noise": amount(random, 0.01, 0.1, "mm"), "points": targets(random, int(random.integers(3, 6)), 0.5 * robot.size)}
    measurement = {"type": "pose", "device": device}
    if chance(random, 0.4):
        measurement["components"] = pick(random, [["x", "y", "z"], ["x", "z", "ry"], ["x", "y", "z", "rx", "rz"], ["rx", "ry", "rz", "y"]])
    return measurement


def distance(random, robot):
    device = {"type": "isotropic", "noise": amount(random, 0.005, 0.05, "mm")}
    if chance(random, 0.6):
        device["noise_per_m"] = amount(random, 0.001, 0.05, "mm")
    measurement = {"type": "distance", "targets": targets(random, int(random.integers(1, 3)), 0.5 * robot.size), "device": device}
    if chance(random, 0.35):
        # Not shorter than what differences are taken over.
        return measurement | {"between": "configurations", "range": [0.1 * robot.size, 10.0]}
    names = ["C1", "C2", "C3", "C4", "C5"][:random.integers(3, 6)]
    anchors = {name: (random.choice([-1, 1], 3) * random.uniform(robot.size, 3 * robot.size, 3)).round(4).tolist() for name in names}
    return measurement | {"anchors": anchors}


def camera(random, robot):
    """Camera and board face each other where the robot stands in the middle of its workspace, which is made small."""
    on_hand, away = chance(random, 0.5), 1.5 * robot.size
    robot.confine()
    carried = {"position": rounded(random, 0.1 * robot.size), "rpy": rounded(random, 3)}
    lens = {"focal": [1500, 1520], "centre": [960, 600], "size": [1920, 1200], "distortion": rounded(random, 0.05, 5)}
    board = {"rows": 3, "columns": 4, "spacing": float(f"{0.06 * robot.size:.4f}")}
    opposite = robot.opposite(carried, away, board["spacing"], on_hand)
    lens, board = (lens | carried, board | opposite) if on_hand else (lens | opposite, board | carried)
    return {"type": "camera", "mount": "hand" if on_hand else "fixed", "camera": lens, "board": board,
            "device": {"type": "isotropic", "noise": float(f"{random.uniform(0.05, 0.5):.3f}")}}


def joints(random, robot):
    measurement = {"type": "joints", "device": {"type": "isotropic", "noise": amount(random, 0.005, 0.05, "deg")}}
    return measurement | pick(random, [{}, {"sensors": ["leg_2.elbow"]}, {"repeats": 3}])


INSTRUMENTS = {"points": points, "pose": pose, "distance": distance, "camera": camera, "joints": joints, "pins": pins}
