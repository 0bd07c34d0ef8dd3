#!/usr/bin/python3
"""make_samples.py: writes hand_eye.samples, 12 simulated samples in the form of easy_handeye2. A camera on the hand sees a board;
1 mm and 0.1 deg of noise, the board of sample 5 is off by 40 mm."""
import pathlib

import numpy as np

CAMERA = ([0.062, -0.018, 0.085], [0.02, -0.03, 1.55])  # in the tip: m, rotation vector in rad
BOARD = ([0.61, 0.08, 0.004], [0.01, 0.02, 0.7])  # in the base


def turn(v):
    angle = np.linalg.norm(v)
    x, y, z = v / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def pose(position, rotation):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = turn(np.array(rotation)), position
    return X


def quaternion(R):
    """x, y, z, w; the largest of the four is found first, so that none of a half turn is lost."""
    K = np.array([[R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
                  [R[1, 0] + R[0, 1], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
                  [R[2, 0] + R[0, 2], R[2, 1] + R[1, 2], R[2, 2] - R[0, 0] - R[1, 1], 0],
                  [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]]])
    return np.linalg.eigh(K)[1][:, 3]


def transform(name, X):
    p, q = ([f"{v:.9g}" for v in values] for values in (X[:3, 3], quaternion(X[:3, :3])))
    return (f"{name}:\n    translation: {{x: {p[0]}, y: {p[1]}, z: {p[2]}}}\n"
            f"    rotation: {{x: {q[0]}, y: {q[1]}, z: {q[2]}, w: {q[3]}}}\n")


def main():
    g = np.random.default_rng(1)
    text = "# Simulated: robot is the tip in the base, tracking the board in the camera.\nparameters:\n"
    text += "  name: simulated\n  calibration_type: eye_in_hand\nsamples:\n"
    for k in range(12):
        tip = pose([0.5, 0, 0.5] + g.uniform(-0.15, 0.15, 3), [np.pi, 0, 0]) @ pose([0, 0, 0], 0.4 * g.normal(size=3))
        seen = np.linalg.inv(tip @ pose(*CAMERA)) @ pose(*BOARD)
        seen[:3, :3] = turn(np.deg2rad(0.1) * g.normal(size=3)) @ seen[:3, :3]
        seen[:3, 3] += 1e-3 * g.normal(size=3) + [0.04 * (k == 4), 0, 0]
        text += transform("- robot", tip) + transform("  tracking", seen)
    (pathlib.Path(__file__).parent / "hand_eye.samples").write_text(text)


if __name__ == "__main__":
    main()
