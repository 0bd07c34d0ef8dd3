"""A serial arm in Denavit–Hartenberg parameters, from where its axes are at zero position.

From one axis to the next: Rz(theta) Tz(d) Tx(a) Rx(alpha); where both are parallel Rz(theta) Tx(a) Rx(alpha) Ry(beta) (Hayati), d
left out. `dh` names a, alpha and beta after the joint before them, `mdh` after the joint behind them."""
import numpy as np

from arm import frame
from quantities import displacement, six, stands_at, turn
from serial_arm import SerialArm

X, Y, Z = np.eye(3)


class DenavitHartenbergArm(SerialArm):
    def __init__(self, spec, folder, convention):
        super().__init__(spec, folder)
        axes, tip = self.axes_at_zero()
        # Which way x points in the first frame is nobody's definition: only base.* and theta of the first joint tell.
        self.X_MeasureBase = along(axes[0][0], axes[0][1], self.X_MeasureBase[:3, 0])
        self.motions, last = steps(self.joints, axes, self.X_MeasureBase, convention)
        self.X_LastTip = np.linalg.inv(last) @ tip
        self.nominal = six("base") | six("tool") | {name: amount for name, _, _, amount, _ in self.motions}
        self.stands = stands_at("base", self.X_MeasureBase) | stands_at("tool", self.X_LastTip)

    def axes_at_zero(self):
        frames, tip = self.frames({name: 0.0 for name in self.coordinates}, self.nominal)
        return [(X[:3, 3], X[:3, :3] @ joint.axis) for joint, X in zip(self.joints, frames)], tip

    def tip(self, pose, values, off=None):
        read = dict(zip(self.coordinates, np.array(pose.q) if off is None else np.array(pose.q) + off))
        X = self.X_MeasureBase @ displacement(values, "base")
        for name, kind, axis, _, moves in self.motions:
            by = values[name] + (read[moves] if moves else 0.0)
            X = X @ (frame(R=turn(axis, by)) if kind == "turn" else frame(by * axis))
        return X @ self.X_LastTip @ displacement(values, "tool")


def along(origin, z, x):
    """A frame at `origin` whose z axis is given, its x axis as near as can be to another one."""
    x = x - (x @ z) * z
    if np.linalg.norm(x) < 1e-6:
        x = np.cross(z, X if abs(z[0]) < 0.9 else Y)
    x = x / np.linalg.norm(x)
    R = np.array([x, np.cross(z, x), z]).T
    return frame(origin, R)


def angle_about(axis, start, end):
    return np.arctan2(axis @ np.cross(start, end), start @ end)


def steps(joints, axes, start, convention):
    """Elementary motions (name, turn or shift, axis, nominal amount, the joint whose reading is added) and the last frame."""
    found, F = [], start
    if convention == "mdh":
        found = [(f"{joints[0].name}.alpha", "turn", X, 0.0, None), (f"{joints[0].name}.a", "shift", X, 0.0, None)]
    for k, joint in enumerate(joints):
        name, moving = joint.name, ("d" if joint.prismatic else "theta")
        theta = d = a = alpha = 0.0
        parallel, link = False, name if convention == "dh" else None
        if k + 1 < len(joints):
            origin, z = axes[k + 1]
            theta, d, a, alpha, parallel = from_axis_to_axis(F, origin, z)
            link = name if convention == "dh" else joints[k + 1].name
        row = [(f"{name}.theta", "turn", Z, theta)]
        if not parallel or joint.prismatic:
            row.append((f"{name}.d", "shift", Z, d))
        if link:
            row += [(f"{link}.a", "shift", X, a), (f"{link}.alpha", "turn", X, alpha)]
            if parallel:
                row.append((f"{link}.beta", "turn", Y, 0.0))
        found += [step + (name if step[0] == f"{name}.{moving}" else None,) for step in row]
        F = F @ frame(R=turn(Z, theta)) @ frame(d * Z) @ frame(a * X) @ frame(R=turn(X, alpha))
    return found, F


def from_axis_to_axis(F, origin, z):
    """theta, d, a, alpha from frame F, its z along one axis, to the next axis; whether both are parallel."""
    z0, o0 = F[:3, 2], F[:3, 3]
    normal = np.cross(z0, z)
    parallel = np.linalg.norm(normal) < 1e-9
    if parallel:
        foot = origin + ((o0 - origin) @ z) * z
        a, d = np.linalg.norm(foot - o0), 0.0
        x = (foot - o0) / a
    else:
        x = normal / np.linalg.norm(normal)
        # The common normal meets the first axis where the vector to the other one is along x.
        between = origin - o0
        d = np.linalg.solve(np.array([z0, -z, x]).T, between)[0]
        a = between @ x
        if a < 0:
            x, a = -x, -a
    return angle_about(z0, F[:3, 0], x), d, a, angle_about(x, z0, z), parallel
