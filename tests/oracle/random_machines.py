"""Arms as factories have them, of random sizes: gantry, SCARA, seven axes."""
from random_arms import Arm
from random_robots import jitter


class Machine(Arm):
    """`axes`: type, axis, place in the link before, range of each joint."""
    axes = []

    def build(self, random):
        self.joints, self.ranges = [f"j{k}" for k in range(1, len(self.axes) + 1)], [axis[3] for axis in self.axes]
        self.sliding = [name for name, axis in zip(self.joints, self.axes) if axis[0] == "prismatic"]
        text, parent = '<robot name="machine"><link name="l0"/>', "l0"
        for name, (kind, axis, place, (low, high)) in zip(self.joints, self.axes):
            at = " ".join(str(jitter(random, x, 0.2)) for x in place)
            text += (f'<link name="l_{name}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="l_{name}"/>'
                     f'<origin xyz="{at}"/><axis xyz="{axis}"/><limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>')
            parent = f"l_{name}"
        text += (f'<link name="tip"/><joint name="end" type="fixed"><parent link="{parent}"/><child link="tip"/>'
                 '<origin xyz="0.02 0 0.1"/></joint></robot>')
        (self.folder / "arm.urdf").write_text(text)
        self.spec, self.count, self.unknowns = {"urdf": "arm.urdf"}, len(self.axes), 4 * len(self.axes)
        if random.random() < 0.5:
            self.spec["encoder_noise"] = float(f"{random.uniform(1e-5, 1e-4):.3e}")

    def nominal(self, random):
        return {}

    def title(self):
        return self.kind


class Gantry(Machine):
    kind = "gantry"
    axes = [("prismatic", "1 0 0", (0, 0, 1.5), (-0.8, 0.8)), ("prismatic", "0 1 0", (0, 0, 0.1), (-0.5, 0.5)),
            ("prismatic", "0 0 1", (0.1, 0, -0.3), (-0.4, 0.3)), ("revolute", "0 0 1", (0, 0, -0.4), (-3, 3)),
            ("revolute", "0 1 0", (0.05, 0, -0.1), (-1.9, 1.9))]


class Scara(Machine):
    kind = "SCARA"
    axes = [("revolute", "0 0 1", (0, 0, 0.4), (-2.2, 2.2)), ("revolute", "0 0 1", (0.35, 0, 0.05), (-2.5, 2.5)),
            ("prismatic", "0 0 1", (0.3, 0, 0), (-0.2, 0.1)), ("revolute", "0 0 1", (0, 0, -0.1), (-3, 3))]


class SevenAxes(Machine):
    kind = "seven axes"
    axes = [("revolute", axis, place, (-2, 2)) for axis, place in
            [("0 0 1", (0, 0, 0.34)), ("0 1 0", (0, 0, 0)), ("0 0 1", (0, 0, 0.4)), ("0 1 0", (0.08, 0, 0)), ("0 0 1", (-0.08, 0, 0.4)),
             ("0 1 0", (0, 0, 0)), ("0 0 1", (0.09, 0, 0))]]


MACHINES = [Gantry, Scara, SevenAxes]
