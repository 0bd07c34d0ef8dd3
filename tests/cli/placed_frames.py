"""Frames that calibrate states are where the readings say, by transforms of their own: placed_frames.py PROGRAM SOURCE.

A picture is what a pinhole at the stated camera sees of the stated board; a tracker's reading is the stated base times the forward
kinematics of the written URDF times the target. Both leave the residuals that calibrate states.
Cameras and boards that numpy draws from the tolerances show how often a planned pose is lost: seldom with `readable_for`, else as often as
plan and simulate say."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from urdf_kinematics import chain_of, forward, placed, rigid

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
TARGETS = {"P1": [0.240, 0.0296, -0.0955], "P2": [0.240, 0.0688, 0.0921], "P3": [0.240, -0.0856, 0.0277]}
UNITS = {"m": 1, "mm": 1e-3, "rad": 1, "deg": np.pi / 180, "px": 1}


def run(folder, *words):
    done = subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return done.stdout


def measured(folder):
    """Rows of measured.csv in SI by the names in its header."""
    lines = [line for line in (folder / "measured.csv").read_text().splitlines() if not line.startswith("#")]
    for row in csv.DictReader(lines):
        numbers = {}
        for head, cell in row.items():
            name, _, unit = head.partition(" [")
            try:
                numbers[name] = float(cell) * UNITS[unit.rstrip("]") or "rad"]
            except (KeyError, ValueError):
                continue
        yield numbers


def frames_of(calibration):
    """Their roll, pitch and yaw are the same rotation as the quaternions, in the range of the problem file's."""
    for f in calibration["frames"]:
        roll, pitch, yaw = f["rpy"]
        assert np.allclose(placed(*f["position"], roll, pitch, yaw), rigid(f["position"], f["quaternion_xyzw"]), atol=1e-12), f
        assert abs(pitch) <= np.pi / 2 and max(abs(roll), abs(yaw)) <= np.pi, f
    return {f["name"]: (f["in"], rigid(f["position"], f["quaternion_xyzw"])) for f in calibration["frames"]}


def stated(calibration, kind):
    return next(r["rms"] for r in calibration["residuals"] if r["poses"] == "fitted" and r["parameters"] == "calibrated" and r["kind"] == kind)


def prepare(folder, *instrument):
    (folder / "arm.urdf").write_text((SOURCE / "examples/kr270/kr270.urdf").read_text())
    run(folder, "init", "arm.urdf", *instrument, "--force")
    run(folder, "plan", "problem.yaml", "--candidates", "200", "--restarts", "1", "--proof-time", "0", "--force", "-o", "plan.json")
    run(folder, "simulate", "problem.yaml", "plan.json", "--draws", "2", "--data", "measured.csv", "--force")


BOARD = np.array([[c * 0.025, r * 0.025, 0, 1] for r in range(6) for c in range(9)])


def pixels(T, board):
    """Image of the board's points by a camera at T, and whether all of them are in it."""
    p = (np.linalg.inv(T) @ board @ BOARD.T)[:3]
    image = (1386 * p[:2] / p[2] + [[960], [540]]).T
    return image, (p[2] > 0).all() and ((image >= 0) & (image <= [1920, 1080])).all()


def lost_poses(folder, chain, draws=200):
    """Poses a draw of which the board is not whole in the picture, camera and board 5 mm and 1 deg (1 sigma) off along each axis."""
    plan, random = json.loads((folder / "plan.json").read_text()), np.random.default_rng(11)
    tips = [forward(chain, pose["configuration"]) for pose in plan["poses"]]
    camera, board = rigid([0.25, 0.06, 0], [0, np.sqrt(0.5), 0, np.sqrt(0.5)]), rigid([1.25, 0.0625, -0.74], [1, 0, 0, 0])
    sigma, lost = np.array([5e-3] * 3 + [np.pi / 180] * 3), 0
    assert all(pixels(T @ camera, board)[1] for T in tips)
    for _ in range(draws):
        real = [X @ placed(*(sigma * random.normal(size=6))) for X in (camera, board)]
        lost += sum(not pixels(T @ real[0], real[1])[1] for T in tips)
    return lost / draws, len(tips)


def check_lost(folder, chain):
    lost = {}
    for robots in (20, 0):
        problem = folder / "problem.yaml"
        problem.write_text(problem.read_text().replace("readable_for: 20", f"readable_for: {robots}"))
        said = run(folder, "plan", "problem.yaml", "--candidates", "200", "--restarts", "1", "--proof-time", "0", "--force", "-o", "plan.json")
        assert ("cannot be read at these poses" in said) == (robots == 0), said
        simulated = json.loads(run(folder, "simulate", "problem.yaml", "plan.json", "--draws", "200", "--json"))["lost"]["poses_a_draw"]
        lost[robots], poses = lost_poses(folder, chain)
        # Two samples of 200 draws, of a number that varies from draw to draw by no more than the number of poses.
        assert abs(lost[robots] - simulated) < 4 * poses / 2 * np.sqrt(2 / 200), (robots, lost, simulated)
        print(f"readable_for: {robots}: {lost[robots]:.2f} of {poses} poses are lost, simulate says {simulated:.2f}")
    assert lost[20] < 0.05 * poses < 0.5 * lost[0], lost


def check_camera(folder):
    prepare(folder, "--camera", "realsense-d435", "--board", "6x9x25mm")
    calibration = json.loads(run(folder, "calibrate", "problem.yaml", "measured.csv", "--json"))
    frames, chain = frames_of(calibration), chain_of((folder / "arm.urdf").read_text(), "flange")
    keys = {f["name"]: f["key"] for f in calibration["frames"]}
    assert keys == {"base": "robot: placement", "camera": "measurement: camera", "board": "measurement: board"}, keys
    said = run(folder, "calibrate", "problem.yaml", "measured.csv")
    assert said.index("Estimated position and orientation of frames") < said.index("parameter  tolerance"), said
    assert frames["camera"][0] == "tip" and frames["board"][0] == "measurement", frames
    squares, moved = [], frames["camera"][1] @ np.linalg.inv(rigid([0.25, 0.06, 0], [0, np.sqrt(0.5), 0, np.sqrt(0.5)]))
    for row in measured(folder):
        T = forward(chain, [row[f"joint_a{k}"] for k in range(1, 7)]) @ frames["camera"][1]
        for i, (u, v) in enumerate(pixels(T, frames["board"][1])[0], 1):
            squares += [(row[f"point_{i}.u"] - u) ** 2, (row[f"point_{i}.v"] - v) ** 2]
    rms = np.sqrt(np.mean(squares))
    assert abs(rms / stated(calibration, "px") - 1) < 1e-6 and np.abs(moved - np.eye(4)).max() > 1e-3, (rms, stated(calibration, "px"))
    print(f"camera and board as stated: {rms:.4f} px of {len(squares)} readings, as calibrate says")
    (folder / "camera.yaml").unlink(missing_ok=True)
    run(folder, "calibrate", "problem.yaml", "measured.csv", "-o", "camera.yaml")
    done = subprocess.run([PROGRAM, "compensate", "camera.yaml", "poses.csv"], cwd=folder, capture_output=True, text=True)
    assert "no parameter of the robot was estimated in variant 'hand_eye'" in done.stderr + done.stdout, done.stderr
    check_lost(folder, chain)


def check_tracker(folder, kind):
    """@param kind  of the parameters: joint frames' (auto) or Denavit–Hartenberg's (dh)"""
    prepare(folder, "--tracker")
    problem = folder / "problem.yaml"
    problem.write_text(problem.read_text().replace("parameters: auto", f"parameters: {kind}"))
    calibration = json.loads(run(folder, "calibrate", "problem.yaml", "measured.csv", "--urdf", "real.urdf", "--json", "--force"))
    values = {p["name"]: p["value"] for p in calibration["parameters"]}
    frames, chain = frames_of(calibration), chain_of((folder / "real.urdf").read_text(), "flange")
    assert frames["base"][0] == "measurement"
    squares = []
    for row in measured(folder):
        T = np.linalg.inv(frames["station.A"][1]) @ frames["base"][1] @ forward(chain, [row[f"joint_a{k}"] for k in range(1, 7)])
        for name, nominal in TARGETS.items():
            p = [values.get(f"target.{name}.{axis}", at) for axis, at in zip("xyz", nominal)]
            squares.append(sum((row.get(f"{name}.{axis}", np.nan) - (T @ [*p, 1])[k]) ** 2 for k, axis in enumerate("xyz")))
    rms = np.sqrt(np.nanmean(squares))
    # 17 digits of a URDF's origins are not what is left: its readers turn by roll, pitch and yaw.
    assert abs(rms / stated(calibration, "distance") - 1) < 1e-4, (rms, stated(calibration, "distance"))
    print(f"base as stated, {kind}: {1e3 * rms:.5f} mm of {len(squares)} targets, as calibrate says")


with tempfile.TemporaryDirectory() as name:
    check_camera(pathlib.Path(name))
    for kind in ("auto", "dh"):
        check_tracker(pathlib.Path(name), kind)
