#!/usr/bin/env python3
"""Writes the positioner's data as `posewright calibrate` reads them: convert.py [FOLDER] [data.csv].

FOLDER holds measurements.csv: j1_rad, j2_rad, and the pose of the target in the camera's frame, x_m y_m z_m qw qx qy qz.
"""

import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE.parents[2].parent / "shared" / "data" / "rosi_two_axis_positioner"
COLUMNS = {"j1_rad": "joint_1 [rad]", "j2_rad": "joint_2 [rad]", "x_m": "pose.x [m]", "y_m": "pose.y [m]",
           "z_m": "pose.z [m]", "qx": "pose.qx", "qy": "pose.qy", "qz": "pose.qz", "qw": "pose.qw"}


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else FOLDER
    out = pathlib.Path(arguments[1]) if len(arguments) > 1 else pathlib.Path("data.csv")
    if not folder.is_dir():
        sys.exit(f"{folder}: no such folder; see {HERE / 'README.md'}")
    with open(folder / "measurements.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(out, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["id"] + list(COLUMNS.values()))
        for number, row in enumerate(rows, 1):
            writer.writerow([number] + [row[name] for name in COLUMNS])


if __name__ == "__main__":
    main(sys.argv[1:])
