#!/usr/bin/env python3
"""Writes the UR5's data as `posewright calibrate` reads them: convert.py [FOLDER [OUT]], OUT/grid.csv and OUT/random.csv.

FOLDER holds grid.csv and random.csv: x_t … (mm, tip by the nominal model), x_dif … (mm, that less the reading), joint_1 … (deg).
"""

import csv
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE.parents[2].parent / "shared" / "data" / "ur5_gts3800"


def convert(folder, out):
    if not folder.is_dir():
        sys.exit(f"{folder}: no such folder; see {HERE / 'README.md'}")
    for name in ("grid.csv", "random.csv"):
        with open(folder / name, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with open(out / name, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["id"] + [f"j{k} [rad]" for k in range(1, 7)] + [f"T.{axis} [m]" for axis in "xyz"])
            for number, row in enumerate(rows, 1):
                joints = [math.radians(float(row[f"joint_{k}"])) for k in range(1, 7)]
                readings = [(float(row[f"{axis}_t"]) - float(row[f"{axis}_dif"])) / 1e3 for axis in "xyz"]
                writer.writerow([number] + joints + readings)


if __name__ == "__main__":
    words = [pathlib.Path(word) for word in sys.argv[1:]]
    convert(words[0] if words else FOLDER, words[1] if len(words) > 1 else pathlib.Path("."))
