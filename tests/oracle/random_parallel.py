"""Random robots with closed loops: six legs that slide or extend, five-bars, deltas; and the linkage of a compensator alone."""
import numpy as np

from random_robots import RandomRobot, jitter, rounded


class SixPus(RandomRobot):
    kind, size, unknowns, model = "six_pus", 0.3, 48, "six_pus"
    base, platform, bases, angles = 0.15, 0.18, (85, 95, 205, 215, 325, 335), (42, 138, 162, 258, 282, 18)

    def build(self, random):
        legs = []
        for base, angle in zip(self.bases, np.radians(self.angles)):
            height = random.uniform(-0.2, 0.2)
            b = jitter(random, self.platform) * np.array([np.cos(angle), np.sin(angle), height])
            legs.append({"a": {"radius": jitter(random, self.base), "angle": f"{base + random.uniform(-4, 4):.2f} deg"},
                         "b": [float(f"{x:.5f}") for x in b]})
            if random.random() < 0.5:
                legs[-1]["a"]["z"] = f"{random.uniform(-20, 20):.1f} mm"
            self.finish_leg(random, legs[-1])
        reference = {"position": [0.01, -0.005, 0.48], "rpy": rounded(random, 0.05)}
        self.spec = {"model": self.model, "reference": reference, "actuators": {"travel": [-0.2, 0.2]}, "legs": legs}
        if random.random() < 0.7:
            self.spec["actuators"]["noise"] = f"{random.uniform(0.5, 10):.2f} um"
        self.ranges = [(-0.02, 0.02)] * 3 + [(-0.15, 0.15)] * 3
        self.workspace = {"pose": dict(zip(("x", "y", "z", "rx", "ry", "rz"), [list(limits) for limits in self.ranges]))}

    def finish_leg(self, random, leg):
        leg["l"] = jitter(random, 0.5, 0.02)
        if random.random() < 0.5:
            leg["u"] = [*rounded(random, 0.3, 2), 1]

    def parameters(self, random, measurement):
        self.gives = random.choice(["rigid", "kappa", "kappa_i", "K", "auto"])
        if self.gives == "auto":
            return "auto"
        more = {"rigid": ["*.ux", "*.uy"], "kappa": ["kappa"], "kappa_i": ["kappa_*"], "K": [f"K_{i}{i}" for i in range(1, 7)]}
        return ["*.ax", "*.ay", "*.bx", "*.by", "*.l"] + more[self.gives]

    def nominal(self, random):
        if self.gives == "rigid":
            return {}
        diagonal = dict(zip([f"K_{i}{i}" for i in range(1, 7)], rounded(random, 0.04, 6)))
        return {"kappa": rounded(random, 0.05)[0], "kappa_2": 0.02, "K_13": -0.017, "K_31": 0.009} | diagonal


class Gough(SixPus):
    kind, model, base, platform, unknowns = "gough", "gough", 0.25, 0.15, 42
    bases, angles = (50, 130, 170, 250, 290, 370), (80, 100, 200, 220, 320, 340)

    def finish_leg(self, random, leg):
        leg["l"] = 0.45 if random.random() < 0.8 else 0.4

    def parameters(self, random, measurement):
        return "auto" if random.random() < 0.6 else ["*.ax", "*.ay", "*.az", "*.bx", "*.l"]

    def nominal(self, random):
        return {"leg_?.az": "12 mm", "base.r?": 0.03, "leg_2.l": "460 mm"} if random.random() < 0.5 else {}


class FiveBar(RandomRobot):
    kind, size, unknowns, instruments = "five_bar", 0.3, 10, ["joints", "points", "distance", "joints", "pose"]

    def build(self, random):
        sides = ["left", "right"] if random.random() < 0.6 else ["left", "left"]
        legs = [{"base": [jitter(random, x), jitter(random, 0.02, 1)], "proximal": jitter(random, 0.25), "distal": jitter(random, 0.36),
                 "elbow": side} for x, side in zip((-0.15, 0.15), sides)]
        self.spec = {"model": "five_bar", "legs": legs, "range": {"x": [-0.1, 0.1], "y": [0.28, 0.42]}}
        if random.random() < 0.7:
            self.spec["encoder_noise"] = f"{random.uniform(0.001, 0.02):.4f} deg"
        self.ranges = [(-0.1, 0.1), (0.28, 0.42)]

    def parameters(self, random, measurement):
        if random.random() < 0.4:
            return "auto"
        return ["leg_?.proximal", "leg_?.distal", "leg_?.offset"] + (["leg_?.sensor_offset"] if measurement["type"] == "joints" else [])

    def nominal(self, random):
        return {"*.offset": "0.7 deg", "leg_2.sensor_offset": -0.02, "leg_1.ay": "25 mm"} if random.random() < 0.5 else {}


class Delta(RandomRobot):
    kind, size, unknowns, lengths = "delta", 0.4, 18, ["leg_?.arm", "leg_1.*radius"]

    def build(self, random):
        self.ranges = [(-0.15, 0.15), (-0.15, 0.15), (-0.8, -0.6)]
        self.spec = {"model": "delta", "base_radius": jitter(random, 0.2), "platform_radius": jitter(random, 0.05),
                     "arm": jitter(random, 0.3), "forearm": jitter(random, 0.7), "travel": ["-40 deg", "80 deg"],
                     "range": dict(zip("xyz", [list(limits) for limits in self.ranges]))}
        if random.random() < 0.7:
            self.spec["encoder_noise"] = f"{random.uniform(0.001, 0.02):.4f} deg"

    def parameters(self, random, measurement):
        return "auto" if random.random() < 0.6 else ["leg_?.arm", "leg_?.forearm", "leg_?.offset", "leg_?.base_radius"]

    def nominal(self, random):
        return {"leg_2.azimuth": "122 deg", "leg_?.offset": "-0.8 deg", "leg_1.arm": f"{1e3 * self.spec['arm'] + 3:.2f} mm"} if random.random() < 0.5 else {}


class Compensator(RandomRobot):
    kind, size, unknowns, instruments, lengths = "compensator", 0.5, 4, ["pins"], ["a?", "L"]

    def __init__(self, random, folder):
        self.folder = folder
        self.spec = {"model": "compensator", "L": jitter(random, 0.18), "ax": jitter(random, 0.69), "ay": jitter(random, 0.12, 2),
                     "range": [-2.4, 0.1]}
        if random.random() < 0.5:
            self.spec["encoder_noise"] = "0.01 deg"

    def parameters(self, random, measurement):
        return ["L", "ax", "ay", "auto"] if random.random() < 0.5 else ["L", "ax", "ay"]
