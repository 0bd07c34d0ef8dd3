#!/usr/bin/env python3
"""Writes the Franka data as `posewright calibrate` reads them: convert.py [FOLDER] [data.csv].

FOLDER holds measurements.csv: q1_rad … q7_rad, and cam_rc, rows 0 to 2 of the camera's pose in the frame of the board.
"""

import csv
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE.parents[2].parent / "shared" / "data" / "franka_realsense_board"


def quaternion(m):
    """x, y, z, w of a rotation matrix, by the largest of the four (Shepperd 1978)."""
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + 2 * m[i][i] - trace for i in range(3)] + [1 + trace]
    k = max(range(4), key=squares.__getitem__)
    root = math.sqrt(squares[k])
    q = [0.0] * 4
    q[k] = root / 2
    if k == 3:
        q[0], q[1], q[2] = ((m[2][1] - m[1][2]) / (2 * root), (m[0][2] - m[2][0]) / (2 * root),
                            (m[1][0] - m[0][1]) / (2 * root))
    else:
        i, j = (k + 1) % 3, (k + 2) % 3
        q[i] = (m[i][k] + m[k][i]) / (2 * root)
        q[j] = (m[j][k] + m[k][j]) / (2 * root)
        q[3] = (m[j][i] - m[i][j]) / (2 * root)
    norm = math.sqrt(sum(x * x for x in q))
    return [x / norm for x in q]


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else FOLDER
    out = pathlib.Path(arguments[1]) if len(arguments) > 1 else pathlib.Path("data.csv")
    if not folder.is_dir():
        sys.exit(f"{folder}: no such folder; see {HERE / 'README.md'}")
    with open(folder / "measurements.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    header = ["id"] + [f"panda_joint{i} [rad]" for i in range(1, 8)]
    header += [f"pose.{axis} [m]" for axis in "xyz"] + [f"pose.q{axis}" for axis in "xyzw"]
    with open(out, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for number, row in enumerate(rows, 1):
            turn = quaternion([[float(row[f"cam_{r}{c}"]) for c in range(3)] for r in range(3)])
            writer.writerow([number] + [row[f"q{i}_rad"] for i in range(1, 8)] + [row[f"cam_{r}3"] for r in range(3)] +
                            [repr(x) for x in turn])


if __name__ == "__main__":
    main(sys.argv[1:])
