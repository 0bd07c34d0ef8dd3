#!/usr/bin/env python3
"""Writes the FANUC data as `posewright calibrate` reads them: convert.py [FOLDER] [data.csv].

FOLDER holds fanuc_q.csv (rad) and fanuc_mA.csv, fanuc_mB.csv, fanuc_mC.csv (m), the same rows in each.
"""

import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE.parents[2].parent / "shared" / "data" / "fanuc_r2000"


def rows(folder, name):
    with open(folder / name, newline="", encoding="utf-8") as file:
        return [row for row in csv.reader(file) if row]


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else FOLDER
    out = pathlib.Path(arguments[1]) if len(arguments) > 1 else pathlib.Path("data.csv")
    if not folder.is_dir():
        sys.exit(f"{folder}: no such folder; see {HERE / 'README.md'}")
    parts = [rows(folder, f"fanuc_{name}.csv") for name in ("q", "mA", "mB", "mC")]
    if len({len(part) for part in parts}) != 1:
        sys.exit(f"{folder}: the four files have different numbers of rows")
    header = [f"joint_{i} [rad]" for i in range(1, 7)]
    header += [f"{target}.{axis} [m]" for target in "ABC" for axis in "xyz"]
    with open(out, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["id"] + header)
        number, last = 0, None
        for row in zip(*parts):
            number += row[0] != last
            last = row[0]
            writer.writerow([number] + [cell for part in row for cell in part])


if __name__ == "__main__":
    main(sys.argv[1:])
