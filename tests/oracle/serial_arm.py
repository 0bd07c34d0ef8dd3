"""A serial arm by definition: a URDF's chain multiplied out, joints that are springs under a load.

Parameters: base.*, NAME.{x … rz} of every moving joint's frame in its parent before it moves, NAME.offset, NAME.gear, tool.*; with springs
NAME.compliance and what stands for it."""
import fnmatch
import xml.etree.ElementTree

import numpy as np

from arm import frame
from quantities import displacement, placement, point, si, six, stands_at, turn, turn_rpy, vector


def numbers(element, key, default):
    return [float(x) for x in ((element.get(key) if element is not None else None) or default).split()]


class Joint:
    """A moving joint; the fixed ones before it are in `parent`. `bodies`: what it carries up to the next, (kg, m).
    Passed from child to parent, it moves the other way. `origin`: from the joint that moves above it in the URDF."""

    def __init__(self, element, parent, origin, backward=False):
        self.name, self.parent, self.bodies, self.origin, self.backward = element.get("name"), parent, [], origin, backward
        axis = np.array(numbers(element.find("axis"), "xyz", "1 0 0"))
        self.axis, self.prismatic = axis / np.linalg.norm(axis), element.get("type") == "prismatic"
        if backward:
            self.axis = -self.axis
        self.mimic = element.find("mimic")
        # A joint that follows another one: what bends it bends that one, geared.
        self.leader = self.name if self.mimic is None else self.mimic.get("joint")
        self.ratio = 1.0 if self.mimic is None else float(self.mimic.get("multiplier", 1))
        self.start = 0.0 if self.mimic is None else float(self.mimic.get("offset", 0))

    def motion(self, by):
        return frame(by * self.axis) if self.prismatic else frame(R=turn(self.axis, by))

    def moved(self, by, displaced):
        """From the frame before the joint to that behind it."""
        if self.backward:
            return self.parent @ self.motion(by) @ np.linalg.inv(displaced)
        return self.parent @ displaced @ self.motion(by)


def held_values(hold, elements):
    """Where joints that do not move are held, by name, those that follow them too."""
    movable = {e.get("name"): e for e in elements if e.get("type") != "fixed"}
    held = {name: si(value) for pattern, value in hold.items() for name, e in movable.items()
            if fnmatch.fnmatchcase(name, pattern) and e.find("mimic") is None}
    for name, e in movable.items():
        mimic = e.find("mimic")
        if mimic is not None and mimic.get("joint") in held:
            held[name] = float(mimic.get("multiplier", 1)) * held[mimic.get("joint")] + float(mimic.get("offset", 0))
    return held


def read_chain(urdf, base, tip, hold):
    """The moving joints from base to tip and the frame of the tip in the last one's."""
    root = xml.etree.ElementTree.parse(urdf).getroot()
    elements, links = list(root.iter("joint")), {link.get("name"): link for link in root.findall("link")}
    elements = [e for e in elements if e.find("parent") is not None]
    by_child = {e.find("child").get("link"): e for e in elements}
    if tip is None:
        (tip,) = set(links) - {e.find("parent").get("link") for e in elements}
    up, link = [], base
    while link in by_child:
        up.append(by_child[link])
        link = by_child[link].find("parent").get("link")
    ancestors = [base] + [e.find("parent").get("link") for e in up]
    down, link = [], tip
    while link in by_child and link not in ancestors:
        down.insert(0, by_child[link])
        link = by_child[link].find("parent").get("link")
    backward = up[:ancestors.index(link)] if base is not None else []
    held = held_values(hold, elements)

    def moves(element):
        return element.get("type") != "fixed" and element.get("name") not in held

    def origin_of(element):
        origin = element.find("origin")
        passed = frame(numbers(origin, "xyz", "0 0 0"), turn_rpy(*numbers(origin, "rpy", "0 0 0")))
        still = element.get("name") in held
        return passed @ Joint(element, None, None).motion(held[element.get("name")]) if still else passed

    def origin_behind_moving(element):
        X, above = origin_of(element), by_child.get(element.find("parent").get("link"))
        while above is not None and not moves(above):
            X, above = origin_of(above) @ X, by_child.get(above.find("parent").get("link"))
        return X

    joints, X = [], np.eye(4)
    for element in backward + down:
        passed = origin_of(element)
        up_the_tree = element in backward
        if not up_the_tree:
            X = X @ passed
        if moves(element):
            joints.append(Joint(element, X, origin_behind_moving(element) if up_the_tree else X, up_the_tree))
            X = np.eye(4)
        if up_the_tree:
            X = X @ np.linalg.inv(passed)
            continue
        inertial = links[element.find("child").get("link")].find("inertial")
        if inertial is not None and joints:
            centre = np.array(numbers(inertial.find("origin"), "xyz", "0 0 0"))
            joints[-1].bodies.append((float(inertial.find("mass").get("value")), point(X, centre)))
    return joints, X


class SerialArm:
    def __init__(self, spec, folder):
        self.joints, self.X_LastTip = read_chain(folder / spec["urdf"], spec.get("base"), spec.get("tip"),
                                                 spec.get("hold", {}))
        self.X_MeasureBase = placement(spec.get("placement"))
        self.coordinates = [joint.name for joint in self.joints if joint.mimic is None]
        self.reading_noise = np.full(len(self.coordinates), si(spec.get("encoder_noise", 0)))
        self.springs = Springs(spec["elastostatic"], self) if "elastostatic" in spec else None
        self.nominal, self.stands = six("base") | six("tool"), stands_at("base", self.X_MeasureBase) | stands_at("tool", self.X_LastTip)
        for joint in self.joints:
            self.nominal |= six(joint.name)
            self.stands |= stands_at(joint.name, joint.origin)
            if joint.mimic is None:
                self.nominal |= {f"{joint.name}.offset": 0.0, f"{joint.name}.gear": 0.0}
        if self.springs:
            self.nominal |= self.springs.nominal

    def frames(self, moved, values):
        """The frame of every joint in the measurement frame, moved, and that of the tip; moved: by how much, by name."""
        X, found = self.X_MeasureBase @ displacement(values, "base"), []
        for joint in self.joints:
            X = X @ joint.moved(joint.ratio * moved[joint.leader] + joint.start, displacement(values, joint.name))
            found.append(X)
        return found, X @ self.X_LastTip @ displacement(values, "tool")

    def moved(self, read, values):
        """By how much the joints move, by name, where they read so much."""
        return {name: q * (1 + values[name + ".gear"]) + values[name + ".offset"] for name, q in zip(self.coordinates, read)}

    def tip(self, pose, values, off=None):
        """`off`: by how much the joints stand elsewhere than they read."""
        moved = self.moved(np.array(pose.q) if off is None else np.array(pose.q) + off, values)
        if self.springs:
            # Torques are those at the pose as it is planned: how they change with parameters is of second order.
            for name, by in self.springs.deflections(pose, values).items():
                moved[name] += by
        return self.frames(moved, values)[1]


class Springs:
    """Joints as springs: how far a load case, and the weight of links where it counts, bends each of them."""

    def __init__(self, spec, arm):
        self.spec, self.arm, self.torques_at = spec, arm, {}
        self.gravity = vector(spec.get("gravity", [0, 0, -9.81]))
        stated = {joint: si(k) for joint, k in spec.get("compliance", {}).items()}
        self.listed, self.compensator = spec.get("listed"), spec.get("compensator")
        if spec.get("compensator_from") == "compliances":
            # What its spring does is in the compliances that are listed.
            self.compensator = None
        self.nominal = {}
        for name in arm.coordinates:
            if self.compensator and name == self.compensator["joint"]:
                self.nominal[f"{name}.stiffness"] = si(self.compensator["joint_stiffness"])
                self.nominal["compensator.stiffness"] = si(self.compensator["stiffness"])
                self.nominal["compensator.preload"] = si(self.compensator["free_length"]) * si(self.compensator["stiffness"])
            elif self.listed and name == self.listed["joint"]:
                for place in self.listed["at"]:
                    self.nominal[self.listed_name(place)] = stated.get(name, 0.0)
            else:
                self.nominal[f"{name}.compliance"] = stated.get(name, 0.0)

    def listed_name(self, place):
        return f"{self.listed['joint']}.compliance@{np.degrees(si(place)):.6g}deg"

    def torques(self, pose, links):
        """By virtual work on the undeflected arm with its nominal values, by coordinate; with the weight of the links or without."""
        case = self.spec["loads"][pose.load] or {}
        frames, tip = self.arm.frames(self.arm.moved(pose.q, pose.nominal), pose.nominal)
        forces = [(vector(case.get("force", [0, 0, 0])), point(tip, vector(case.get("point", [0, 0, 0])))),
                  (case.get("mass", 0) * self.gravity, point(tip, vector(case.get("centre_of_mass", [0, 0, 0]))))]
        moment, found = vector(case.get("moment", [0, 0, 0])), dict.fromkeys(self.arm.coordinates, 0.0)
        # From the tip inwards: what a link weighs bends all joints that carry it.
        for joint, X in reversed(list(zip(self.arm.joints, frames))):
            forces += [(mass * self.gravity, point(X, centre)) for mass, centre in joint.bodies if links]
            axis = X[:3, :3] @ joint.axis
            if joint.prismatic:
                torque = sum(axis @ force for force, _ in forces)
            else:
                torque = axis @ moment + sum(np.cross(axis, at - X[:3, 3]) @ force for force, at in forces)
            found[joint.leader] += joint.ratio * torque
        return found

    def deflections(self, pose, values):
        key = (tuple(pose.q), pose.load)
        if key not in self.torques_at:
            self.torques_at[key] = self.torques(pose, False), self.torques(pose, self.spec.get("link_weights", False))
        of_load, of_all = self.torques_at[key]
        return {name: self.deflection(name, q, of_load[name], of_all[name], values)
                for name, q in zip(self.arm.coordinates, pose.q)}

    def deflection(self, name, q, load, everything, values):
        if self.listed and name == self.listed["joint"]:
            places = [si(place) for place in self.listed["at"]]
            nearest = self.listed["at"][int(np.argmin(np.abs(np.array(places) - q)))]
            return values[self.listed_name(nearest)] * everything
        if not (self.compensator and name == self.compensator["joint"]):
            return values[f"{name}.compliance"] * everything
        stiffness, preload = values["compensator.stiffness"], values["compensator.preload"]
        torque, added = self.spring(q, stiffness, preload)
        stands = values[f"{name}.stiffness"] + added
        # Unless the problem says otherwise what bends the unloaded arm is in the controller's zero.
        return (everything - torque) / stands if self.compensator.get("effect") == "torque" else load / stands

    def spring(self, q, stiffness, preload):
        """M = (Kc - s0·Kc/s) a L sin γ and dM/dq, γ = α - q, s the spring's length."""
        L, ax, ay = (si(self.compensator[key]) for key in ("L", "ax", "ay"))
        aL, gamma = np.hypot(ax, ay) * L, np.arctan2(ax, ay) - q
        s = np.sqrt(ax**2 + ay**2 + L**2 + 2 * aL * np.cos(gamma))
        torque = (stiffness - preload / s) * aL * np.sin(gamma)
        # ds/dq = aL sin γ / s.
        added = preload / s**2 * (aL * np.sin(gamma))**2 / s - (stiffness - preload / s) * aL * np.cos(gamma)
        return torque, added
