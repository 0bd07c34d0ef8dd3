"""Exports of the golden plan, read as the tools' own Python reads them. Exit 77: a library is not there."""

import csv
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy
    import yaml
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

program, golden = sys.argv[1], Path(sys.argv[2])
plan = [p for p in json.loads((golden / "plan.json").read_text())["poses"] if not p.get("measured")]
names = plan[0]["names"]
wanted = numpy.array([p["configuration"] for p in plan])
folder = Path(tempfile.mkdtemp())


def export(form, name, *words):
    subprocess.run([program, "export", golden / "plan.json", "--to", form, "-o", folder / name, *words], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return folder / name


def same(form, found, limit=0.0):
    found = numpy.array(found, dtype=float)
    assert found.shape == wanted.shape, (form, found.shape)
    assert numpy.abs(found - wanted).max() <= limit, (form, numpy.abs(found - wanted).max())


def floats(values):
    assert all(type(v) is float for v in values), values
    return values


try:
    array = numpy.load(export("pybotics-npy", "p.npy"), allow_pickle=False)
    assert array.dtype == numpy.float64
    same("pybotics-npy", array)
    table = numpy.genfromtxt(export("pybotics-csv", "p.csv"), delimiter=",")
    same("pybotics-csv", numpy.deg2rad(table[:, :-16]), 1e-15)
    assert (table[:, -4:] == [0, 0, 0, 1]).all()
    same("robodk-csv", numpy.deg2rad(numpy.loadtxt(export("robodk-csv", "r.csv"), delimiter=",", skiprows=1)), 1e-15)

    data = yaml.safe_load(export("figaroh", "f.yaml").read_text())
    assert set(data) == {"calibration_joint_names", "calibration_joint_configurations"}
    assert data["calibration_joint_names"] == names
    same("figaroh", [floats(row) for row in data["calibration_joint_configurations"]])
    data = yaml.safe_load(export("moveit", "m.yaml").read_text())
    assert data["joint_names"] == names
    same("moveit", [floats(row) for row in data["joint_values"]])
    data = yaml.safe_load(export("robot-calibration", "c.yaml").read_text())
    assert all(item["joints"] == names and item["features"] == [] for item in data)
    same("robot-calibration", [floats(item["positions"]) for item in data])
    data = yaml.safe_load(export("industrial-calibration", "i.yaml").read_text())
    same("industrial-calibration", [floats(item["target_joints"]) for item in data.values()])
    data = yaml.safe_load(export("joint-trajectory", "t.yaml", "--unchecked").read_text())
    same("joint-trajectory", [floats(point["positions"]) for point in data["points"]][::2])

    # As FIGAROH's load_data: columns by name.
    with open(export("figaroh-csv", "f.csv")) as file:
        rows = list(csv.DictReader(file))
    same("figaroh-csv", [[row[name] for name in names] for row in rows])
    assert float(rows[1]["x1"]) == plan[1]["targets"][0]["position"][0]
    assert numpy.isnan(float(rows[2]["z2"])), "hidden"

    if shutil.which("xmllint"):
        export("srdf", "s.srdf")
        export("staubli-val3", "val3", "--unchecked")
        xml = [folder / "s.srdf", *sorted((folder / "val3").rglob("*.*"))]
        assert len(xml) == 6, xml
        subprocess.run(["xmllint", "--noout", *xml], check=True)
finally:
    shutil.rmtree(folder)
print("all formats read")
