"""What instruments read of a tip's frame, and with which noise, by definition.

`read(X, values, station, seen_from)`: the readings where the tip stands at X; rotations count from the frame `seen_from`.
`noise(X, values, station)`: covariance of one reading of them all. `nominal`: the instrument's own parameters."""
import numpy as np

from arm import AXES
from quantities import displacement, placement, point, rotation_vector, si, six, stands_at, vector


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def block_diagonal(blocks):
    size = sum(len(block) for block in blocks)
    whole, at = np.zeros((size, size)), 0
    for block in blocks:
        whole[at:at + len(block), at:at + len(block)] = block
        at += len(block)
    return whole


def named_points(spec):
    return {str(name): vector(p) for name, p in spec.items()}


class Targets:
    """Points fixed to the tip, with their places there as parameters."""

    def __init__(self, measurement):
        targets = measurement["targets"] if "targets" in measurement else {"target": measurement["target"]}
        self.targets = named_points(targets)
        self.nominal = {f"target.{name}.{axis}": 0.0 for name in self.targets for axis in "xyz"}
        self.stands = {f"target.{name}.{axis}": value for name, p in self.targets.items() for axis, value in zip("xyz", p)}

    def places(self, X, values):
        """Of all targets in the measurement frame."""
        return {name: point(X, p + [values[f"target.{name}.{axis}"] for axis in "xyz"]) for name, p in self.targets.items()}


class Points(Targets):
    def __init__(self, measurement):
        super().__init__(measurement)
        self.device = measurement["device"]
        self.components = ["xyz".index(c) for c in "xyz" if c in measurement.get("components", "xyz")]
        self.stations = {str(name): placement(spec) for name, spec in self.device.get("stations", {}).items()}
        for name, S in self.stations.items():
            self.nominal |= six(f"station.{name}")
            self.stands |= stands_at(f"station.{name}", S)

    def seen(self, X, values, station):
        """Of all targets in the station's axes; without stations the measurement frame is where it stands."""
        S = np.eye(4) if station is None else self.stations[station] @ displacement(values, f"station.{station}")
        return {name: S[:3, :3].T @ (p - S[:3, 3]) for name, p in self.places(X, values).items()}

    def incidence(self, X, faces, seen, values, station):
        """Angle between where a target faces (tip frame) and the line to the station, the target seen at `seen`."""
        S = np.eye(4) if station is None else self.stations[station] @ displacement(values, f"station.{station}")
        normal, to_station = X[:3, :3] @ np.array(faces, float), -S[:3, :3] @ seen
        return np.arccos(normal @ to_station / np.linalg.norm(normal) / np.linalg.norm(to_station))

    def read(self, X, values, station, seen_from):
        return np.concatenate([p[self.components] for p in self.seen(X, values, station).values()])

    def noise(self, X, values, station):
        pick = np.ix_(self.components, self.components)
        return block_diagonal([self.of_point(p)[pick] for p in self.seen(X, values, station).values()])

    def of_point(self, p):
        """Covariance of one point at p in the station's axes."""
        kind, noise = self.device["type"], self.device.get("noise")
        if kind == "covariance":
            return np.array(self.device["matrix"], float)
        if kind != "laser_tracker":
            return np.diag((np.array([si(x) for x in noise]) if isinstance(noise, list) else np.full(3, si(noise)))**2)
        if noise is None:
            noise = {"range": 2.5e-6, "range_per_m": 0.075e-6, "transverse": 3.75e-6, "angle": 1.5e-6}
        amount, distance = {key: si(value) for key, value in noise.items()}, np.linalg.norm(p)
        along = amount.get("range", 0) + amount.get("range_per_m", 0) * distance
        across = amount.get("transverse", 0) + amount.get("angle", 0) * distance
        beam = np.outer(p, p) / distance**2
        return along**2 * beam + across**2 * (np.eye(3) - beam)


class Pose:
    """Position of the tip and its rotation about the measurement frame's axes."""

    def __init__(self, measurement):
        self.device, self.nominal, self.stands = measurement["device"], {}, {}
        self.components = [AXES.index(c) for c in AXES if c in measurement.get("components", AXES)]

    def read(self, X, values, station, seen_from):
        turned = rotation_vector(X[:3, :3] @ seen_from[:3, :3].T)
        return np.concatenate([X[:3, 3], turned])[self.components]

    def noise(self, X, values, station):
        kind = self.device["type"]
        if kind == "isotropic":
            sizes = [si(self.device["noise"]["position"])] * 3 + [si(self.device["noise"]["rotation"])] * 3
            whole = np.diag(np.array(sizes)**2)
        elif kind == "covariance":
            whole = np.array([[si(value) for value in row] for row in self.device["matrix"]])
        else:
            # The pose is the rigid fit to points: p moves by v + ω × (p - tip).
            arms = [X[:3, :3] @ p for p in named_points(self.device["points"]).values()]
            Y = np.vstack([np.hstack([np.eye(3), -skew(arm)]) for arm in arms])
            whole = np.linalg.inv(Y.T @ Y) * si(self.device["noise"])**2
        return whole[np.ix_(self.components, self.components)]


class Anchors(Targets):
    """Distances from fixed anchors to targets."""

    def __init__(self, measurement):
        super().__init__(measurement)
        self.anchors, self.device = named_points(measurement["anchors"]), measurement["device"]
        self.nominal |= {f"anchor.{name}.{key}": 0.0 for name in self.anchors for key in ("x", "y", "z", "length")}
        self.stands |= {f"anchor.{name}.{axis}": value for name, p in self.anchors.items() for axis, value in zip("xyz", p)}

    def read(self, X, values, station, seen_from):
        places = self.places(X, values).values()
        moved = {name: c + [values[f"anchor.{name}.{axis}"] for axis in "xyz"] for name, c in self.anchors.items()}
        return np.array([np.linalg.norm(p - c) + values[f"anchor.{name}.length"] for name, c in moved.items() for p in places])

    def noise(self, X, values, station):
        return distance_noise(self.device, self.read(X, values, station, X))


class Plane:
    """Distance of a probe from a plane along its normal, which tilts by u and v."""

    def __init__(self, measurement):
        plane, self.device = measurement["plane"], measurement["device"]
        self.point, normal = vector(plane["point"]), np.array(plane["normal"], float)
        self.normal, self.probe = normal / np.linalg.norm(normal), vector(measurement["probe"])
        across = np.eye(3)[np.argmin(np.abs(self.normal))]
        self.v = np.cross(self.normal, across) / np.linalg.norm(np.cross(self.normal, across))
        self.u = np.cross(self.v, self.normal)
        names = [f"target.probe.{axis}" for axis in "xyz"]
        self.nominal = dict.fromkeys([*names, "plane.offset", "plane.u", "plane.v"], 0.0)
        self.stands = dict(zip(names, self.probe))

    def read(self, X, values, station, seen_from):
        normal = self.normal + values["plane.u"] * self.u + values["plane.v"] * self.v
        place = point(X, self.probe + [values[f"target.probe.{axis}"] for axis in "xyz"])
        return np.array([normal @ (place - self.point) / np.linalg.norm(normal) - values["plane.offset"]])

    def noise(self, X, values, station):
        return np.array([[si(self.device["noise"])**2]])


class Line:
    """Where a line crosses the plane y = 0 of a profiler on the tip: x and z there."""

    def __init__(self, measurement):
        line, self.device = measurement["line"], measurement["device"]
        self.point, direction = vector(line["point"]), np.array(line["direction"], float)
        self.direction, self.X_sensor = direction / np.linalg.norm(direction), placement(measurement.get("sensor", {}))
        across = np.eye(3)[np.argmin(np.abs(self.direction))]
        self.v = np.cross(self.direction, across) / np.linalg.norm(np.cross(self.direction, across))
        self.u = np.cross(self.v, self.direction)
        self.nominal = six("sensor") | dict.fromkeys(("line.u", "line.v", "line.tilt_u", "line.tilt_v"), 0.0)
        self.stands = stands_at("sensor", self.X_sensor)

    def read(self, X, values, station, seen_from):
        X_sensor = X @ self.X_sensor @ displacement(values, "sensor")
        place = self.point + values["line.u"] * self.u + values["line.v"] * self.v
        way = self.direction + values["line.tilt_u"] * self.u + values["line.tilt_v"] * self.v
        # place + s way = sensor's origin + x e_x + z e_z
        s, x, z = np.linalg.solve(np.column_stack([way, -X_sensor[:3, 0], -X_sensor[:3, 2]]), X_sensor[:3, 3] - place)
        return np.array([x, z])

    def noise(self, X, values, station):
        return si(self.device["noise"])**2 * np.eye(2)


class Inclination:
    """Angles between axes of a level on the tip and the horizontal plane."""

    def __init__(self, measurement):
        self.device, self.nominal, self.stands = measurement["device"], {}, {}
        self.axes = ["xyz".index(axis) for axis in "xyz" if axis in measurement.get("axes", "xy")]
        self.turned = placement({"rpy": measurement.get("rpy", [0, 0, 0])})[:3, :3]
        up = np.array(measurement.get("up", [0, 0, 1]), float)
        self.up = up / np.linalg.norm(up)

    def read(self, X, values, station, seen_from):
        return np.arcsin(self.up @ X[:3, :3] @ self.turned)[self.axes]

    def noise(self, X, values, station):
        return si(self.device["noise"])**2 * np.eye(len(self.axes))


def distance_noise(device, distances):
    return np.diag((si(device["noise"]) + si(device.get("noise_per_m", 0)) * distances)**2)


class Camera:
    """Images of a board's points: a pinhole that looks along z, with radial (k1, k2, k3) and tangential (p1, p2) distortion."""

    def __init__(self, measurement):
        camera, board = measurement["camera"], measurement["board"]
        self.on_hand, self.pixels = measurement["mount"] == "hand", measurement["device"]["noise"]
        self.X_camera, self.X_board, spacing = placement(camera), placement(board), si(board["spacing"])
        self.points = spacing * np.array([[c, r, 0] for r in range(board["rows"]) for c in range(board["columns"])])
        lens = dict(zip(("fx", "fy", "cx", "cy"), [*camera["focal"], *camera["centre"]]))
        lens |= dict(zip(("k1", "k2", "p1", "p2", "k3"), vector(camera.get("distortion", [0] * 5))))
        self.nominal = six("camera") | six("board") | {f"camera.{name}": float(value) for name, value in lens.items()} | {"pattern.scale": 1.0}
        self.stands = stands_at("camera", self.X_camera) | stands_at("board", self.X_board)
        self.rows, self.columns = board["rows"], board["columns"]

    def board_in_camera(self, X, values):
        camera, board = self.X_camera @ displacement(values, "camera"), self.X_board @ displacement(values, "board")
        camera, board = (X @ camera, board) if self.on_hand else (camera, X @ board)
        return np.linalg.inv(camera) @ board

    def in_camera(self, X, values):
        """The board's points in the camera's frame, a row each."""
        X_CameraBoard = self.board_in_camera(X, values)
        return values["pattern.scale"] * self.points @ X_CameraBoard[:3, :3].T + X_CameraBoard[:3, 3]

    def read(self, X, values, station, seen_from):
        return image(self.in_camera(X, values), {key[7:]: value for key, value in values.items() if key[:7] == "camera."}).ravel()

    def seen(self, X, values, station):
        numbers = [f"point {r},{c}" for r in range(1, self.rows + 1) for c in range(1, self.columns + 1)]
        return dict(zip(numbers, self.in_camera(X, values)))

    def incidence(self, X, faces, seen, values, station):
        """Angle between where a point of the board faces (board frame) and the line to the camera, the point seen at `seen`."""
        normal = self.board_in_camera(X, values)[:3, :3] @ np.array(faces, float)
        return np.arccos(-normal @ seen / np.linalg.norm(normal) / np.linalg.norm(seen))

    def noise(self, X, values, station):
        return self.pixels**2 * np.eye(2 * len(self.points))


def image(points, lens):
    """Pixels of points in the camera's frame, a row each."""
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r2 = x * x + y * y
    radial = 1 + lens["k1"] * r2 + lens["k2"] * r2**2 + lens["k3"] * r2**3
    u = x * radial + 2 * lens["p1"] * x * y + lens["p2"] * (r2 + 2 * x * x)
    v = y * radial + lens["p1"] * (r2 + 2 * y * y) + 2 * lens["p2"] * x * y
    return np.array([lens["fx"] * u + lens["cx"], lens["fy"] * v + lens["cy"]]).T


def instrument_of(measurement):
    kind = measurement["type"]
    if kind in ("points", "position"):
        return Points(measurement)
    if kind == "distance":
        return Anchors(measurement)
    return {"pose": Pose, "plane": Plane, "line": Line, "inclination": Inclination, "camera": Camera}[kind](measurement)
