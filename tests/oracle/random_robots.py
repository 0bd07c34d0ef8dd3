"""What every random robot has in common: the place of its base, where cameras and boards must stand, how many poses it needs."""
import numpy as np

from arm import frame
from experiment import Visit, robot_of
from quantities import placement, turn_rpy


def jitter(random, value, share=0.1):
    return float(f"{value * (1 + random.uniform(-share, share)):.5f}")


def rounded(random, size, count=3):
    return [float(f"{x:.4f}") for x in random.uniform(-size, size, count)]


def place_of(X):
    R = X[:3, :3]
    angles = [np.arctan2(R[2, 1], R[2, 2]), np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])), np.arctan2(R[1, 0], R[0, 0])]
    return {"position": [float(x) for x in X[:3, 3]], "rpy": [float(x) for x in angles]}


class RandomRobot:
    """`ranges`: of the coordinates, in SI; `unknowns`: about how many parameters it has; `lengths`: globs of some in m."""
    instruments, workspace, lengths = ["points", "pose", "distance", "camera"], None, ["leg_1.a?", "leg_?.ay"]

    def __init__(self, random, folder):
        self.folder, self.spec = folder, {}
        self.build(random)
        if random.random() < 0.6:
            self.spec["placement"] = {"position": rounded(random, 1), "rpy": rounded(random, 3)}

    def title(self):
        return self.kind

    def parameters(self, random, measurement):
        return "auto"

    def nominal(self, random):
        """Where a variant is linearised in place of the robot's own values."""
        return {}

    def somewhere(self, random):
        return [float(f"{random.uniform(low, high):.4f}") for low, high in self.ranges]

    def confine(self):
        """A workspace in which a camera keeps what it looks at in the image."""

    def opposite(self, carried, away, spacing, on_hand):
        """Where the board stands that a camera on the hand sees, or the camera that sees a board on the hand."""
        robot = robot_of(self.spec, self.folder, "frames")
        load = next(iter(self.spec["elastostatic"]["loads"])) if "elastostatic" in self.spec else None
        middle = tuple((low + high) / 2 for low, high in self.ranges)
        X = robot.tip(Visit(middle, load, None, robot.nominal), robot.nominal) @ placement(carried)
        X_CameraBoard = frame((-1.5 * spacing, -spacing, away), turn_rpy(0.3, -0.4, 0.2))
        return place_of(X @ (X_CameraBoard if on_hand else np.linalg.inv(X_CameraBoard)))

    def poses(self, measurement):
        """Half as many again as the parameters need."""
        count, kind = len(measurement.get("targets", [0])), measurement["type"]
        unknowns = self.unknowns + 6 + 3 * count + 6 * (len(measurement["device"].get("stations", {})) > 1)
        unknowns += 15 * (kind == "camera") + 4 * len(measurement.get("anchors", []))
        parts = len(measurement.get("components", "xyzxyz" if kind == "pose" else "xyz"))
        rows = {"points": parts * count, "pose": parts, "camera": 6, "joints": len(measurement.get("sensors", "12")), "position": parts,
                "distance": len(measurement.get("anchors", [0])) * count}
        return int(np.ceil(1.5 * unknowns / min(rows[kind], 6))) + 3
