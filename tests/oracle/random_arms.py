"""Random serial arms: of any geometry, in Denavit–Hartenberg parameters, with joints that give way."""
from random_robots import RandomRobot, rounded


def numbers(values):
    return " ".join(f"{v:.5f}" for v in values)


class Arm(RandomRobot):
    kind, size, lengths = "arm", 1.0, ["*.x", "j?.z", "j*.y"]
    slides, mimic, weights = True, True, False

    def build(self, random):
        count = int(random.choice([3, 4, 5, 6], p=[0.35, 0.3, 0.2, 0.15]))
        text, parent, self.ranges, self.joints, self.sliding = '<robot name="random"><link name="l0"/>', "l0", [], [], []
        for k in range(1, count + 1):
            if random.random() < 0.2:
                text += self.element(random, f"f{k}", "fixed", parent, f"m{k}", "")
                parent = f"m{k}"
            prismatic = self.slides and k > 1 and random.random() < 0.15
            low, high = (-0.3, 0.4) if prismatic else (-2.0, 2.5)
            more = f'<axis xyz="{self.axis(random)}"/><limit lower="{low}" upper="{high}" effort="1" velocity="1"/>'
            # A joint that follows the one before it, as by a belt.
            follows = self.mimic and k > 2 and not prismatic and self.turns(f"j{k - 1}") and random.random() < 0.15
            if follows:
                more += f'<mimic joint="j{k - 1}" multiplier="-0.6" offset="0.2"/>'
            text += self.element(random, f"j{k}", "prismatic" if prismatic else "revolute", parent, f"l{k}", more)
            parent = f"l{k}"
            if not follows:
                self.ranges.append((low, high))
                self.joints.append(f"j{k}")
            if prismatic:
                self.sliding.append(f"j{k}")
        text += self.element(random, "end", "fixed", parent, "tip", "")
        (self.folder / "arm.urdf").write_text(text + "</robot>")
        self.spec, self.unknowns, self.count = {"urdf": "arm.urdf"}, 4 * count, count
        if random.random() < 0.5:
            self.spec["encoder_noise"] = float(f"{random.uniform(1e-5, 2e-4):.3e}")

    def turns(self, name):
        return name in self.joints and name not in self.sliding

    def element(self, random, name, kind, parent, child, more):
        weight = (f'<inertial><origin xyz="{numbers(random.uniform(-0.2, 0.2, 3))}"/><mass value="{random.uniform(5, 60):.2f}"/></inertial>'
                  if self.weights else "")
        return (f'<link name="{child}">{weight}</link><joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
                f'<origin xyz="{numbers(random.uniform(-0.5, 0.5, 3))}" rpy="{self.turn(random)}"/>{more}</joint>')

    def axis(self, random):
        return numbers(random.normal(size=3)) if random.random() < 0.5 else ["1 0 0", "0 1 0", "0 0 1"][random.integers(3)]

    def turn(self, random):
        return numbers(random.uniform(-3, 3, 3)) if random.random() < 0.6 else "0 0 0"

    def nominal(self, random):
        if random.random() < 0.5:
            return {}
        turns = dict(zip(["j?.rx", "j?.ry", "j?.rz"], rounded(random, 0.05)))
        return turns | {"*.gear": 0.02, f"{self.joints[0]}.offset": "1.5 deg", "base.rx": 0.03}

    def confine(self):
        self.ranges = [(-0.02, 0.22) for _ in self.ranges]
        self.workspace = {"joints": {"limits": {name: list(limits) for name, limits in zip(self.joints, self.ranges)}}}

    def title(self):
        return f"{self.kind} of {self.count} joints"


class DenavitHartenberg(Arm):
    """Axes parallel, crossing at right angles or any other; all turn (where a slide's axis is, is nobody's definition)."""
    kind, slides, mimic, lengths = "dh", False, False, ["j?.a", "*.d"]

    def nominal(self, random):
        return {}

    def turn(self, random):
        return ["0 0 0", "1.5707963267948966 0 0", "0.3 -0.7 1.1"][random.integers(3)]

    def axis(self, random):
        return "0 0 1"

    def parameters(self, random, measurement):
        return "dh" if random.random() < 0.5 else "mdh"


class Springs(Arm):
    """An arm whose joints give way under loads, with or without a gravity compensator."""
    kind, weights = "springs", True

    def build(self, random):
        super().build(random)
        give = {joint: 1e-7 if joint in self.sliding else f"{random.uniform(0.2, 4):.3f} urad/Nm" for joint in self.joints}
        hang = {"mass": 120, "centre_of_mass": rounded(random, 0.4)}
        pull = {"force": rounded(random, 1500), "point": rounded(random, 0.4)}
        twist = {"moment": rounded(random, 400), "force": [0, 0, "-0.6 kN"]}
        elastic = {"compliance": give, "loads": {"hang": hang, "pull": pull, "twist": twist, "all": hang | pull | twist}}
        if random.random() < 0.5:
            elastic["loads"] = {"nothing": {}} | elastic["loads"]
        self.special = random.choice(["none", "listed", "compensator"], p=[0.3, 0.25, 0.45])
        self.known = ["*.compliance*"]
        self.add_special(random, elastic, [joint for joint in self.joints if joint not in self.sliding][0])
        if random.random() < 0.5:
            elastic["link_weights"] = True
        if random.random() < 0.3:
            elastic["gravity"] = rounded(random, 9)
        self.spec["elastostatic"] = elastic
        self.unknowns += len(self.joints) + 3

    def add_special(self, random, elastic, joint):
        if self.special == "listed":
            elastic["listed"] = {"joint": joint, "at": ["-30 deg", "0.2 rad", 1.1]}
            self.ranges[self.joints.index(joint)] = (0.2, 0.2)
            self.instruments = ["points", "pose", "distance"]
        if self.special == "compensator":
            del elastic["compliance"][joint]
            elastic["compensator"] = {"joint": joint, "L": "180 mm", "ax": "690 mm", "ay": f"{random.uniform(-200, 200):.1f} mm",
                                      "stiffness": "700 N/mm", "free_length": "460 mm", "joint_stiffness": 3.3e6}
            if random.random() < 0.5:
                elastic["compensator"]["effect"] = "torque"
            self.known += [f"{joint}.stiffness", "compensator.*"]

    def parameters(self, random, measurement):
        return ["auto", *self.known] if random.random() < 0.7 else self.known

    def title(self):
        return f"{super().title()} ({self.special}{', weights' if self.spec['elastostatic'].get('link_weights') else ''})"
