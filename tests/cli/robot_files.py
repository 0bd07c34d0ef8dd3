"""The files of a calibrated robot are that robot, by a forward kinematics of their own: robot_files.py PROGRAM SOURCE ur|xacro.

The calibrated robot is a product of transforms by the definition of its parameters (docs/problem-file.md). Against it:
kinematics.yaml put into a URDF as ur_description makes it, the URDF and the compensated joints; and what xacro
makes of the corrected xacro file: the program of ROS, or npm's xacro-parser (status 77 without both)."""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import yaml

from urdf_kinematics import chain_of, forward

PROGRAM, SOURCE, WHICH = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
JOINTS = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"]
LINKS = ["shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"]
# config/ur10/default_kinematics.yaml of ur_description: x y z roll pitch yaw
UR10 = [[0, 0, 0.1273, 0, 0, 0], [0, 0, 0, 1.570796327, 0, 0], [-0.612, 0, 0, 0, 0, 0], [-0.5723, 0, 0.163941, 0, 0, 0],
        [0, -0.1157, 0, 1.570796327, 0, 0], [0, 0.0922, 0, 1.570796326589793, 3.141592653589793, 3.141592653589793]]


def ur_description(kinematics):
    """A URDF as ur_description makes it of a kinematics file."""
    text = ('<robot name="ur10"><link name="base_link"/><link name="base_link_inertia"/><joint name="base_inertia" type="fixed"><parent link="base_link"/>'
            '<child link="base_link_inertia"/><origin rpy="0 0 3.141592653589793"/></joint>')
    parent = "base_link_inertia"
    for name, link, (x, y, z, *rpy) in zip(JOINTS, LINKS, kinematics):
        text += (f'<link name="{link}_link"/><joint name="{name}_joint" type="revolute"><parent link="{parent}"/><child link="{link}_link"/>'
                 f'<origin xyz="{x!r} {y!r} {z!r}" rpy="{" ".join(map(repr, rpy))}"/><axis xyz="0 0 1"/>'
                 '<limit lower="-3.1" upper="3.1" effort="1" velocity="2"/></joint>')
        parent = f"{link}_link"
    return text + ('<link name="flange"/><link name="tool0"/>'
                   '<joint name="to_flange" type="fixed"><parent link="wrist_3_link"/><child link="flange"/><origin rpy="0 -1.5707963267948966 -1.5707963267948966"/></joint>'
                   '<joint name="to_tool0" type="fixed"><parent link="flange"/><child link="tool0"/><origin rpy="1.5707963267948966 0 1.5707963267948966"/></joint></robot>')


class Robot:
    """A robot in a folder of its own, with a problem that init wrote and parameters that are drawn."""

    def __init__(self, folder, name, text, expanded, seed):
        self.folder, self.chain = folder, chain_of(expanded)
        (folder / name).write_text(text)
        self.run("init", name, "--tracker", "--tip", "tool0", "--at", "2,-1,0.3", "--floor", "none", "-o", "problem.yaml", "--force")
        # What xacro made stands in the problem, and below it the file that a correction needs.
        problem = folder / "problem.yaml"
        problem.write_text(re.sub(r'  urdf: "problem.urdf"\n(  #.*\n)  # urdf:', r"\1  urdf:", problem.read_text()))
        random = np.random.default_rng(seed)
        self.off = {joint: random.normal(size=7) * 1e-3 for joint, moves, *_ in self.chain if moves}
        sha256 = hashlib.sha256((folder / "problem.yaml").read_bytes()).hexdigest()
        lines = ["posewright_parameters: 1", "variant: geometric", "convention: frames", f"problem: {{file: problem.yaml, sha256: {sha256}}}", "parameters:"]
        for joint, moves, origin, _ in self.chain:
            if not moves:
                continue
            nominal = np.concatenate([origin[:3, :3].T @ origin[:3, 3], np.zeros(4)])
            for key, value in zip(("x", "y", "z", "rx", "ry", "rz", "offset"), nominal + self.off[joint]):
                lines.append(f"  {joint}.{key}: {{value: {float(value)!r}, unit: {'m' if key in 'xyz' else 'rad'}}}")
        (folder / "calibrated.yaml").write_text("\n".join(lines) + "\n")

    def run(self, *words, status=0):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)
        assert done.returncode == status, f"{words}: {done.returncode} {done.stderr}"
        return done

    def same(self, chain, what):
        """The robot of a file is the calibrated one, wherever it stands."""
        random, most, before = np.random.default_rng(5), 0.0, 0.0
        for _ in range(100):
            q = random.uniform(-3, 3, size=6)
            truth = forward(self.chain, q, self.off)
            most = max(most, np.abs(forward(chain, q) - truth).max())
            before = max(before, np.abs(forward(self.chain, q) - truth).max())
        assert most < 1e-9 and before > 1e-3, f"{what}: {most} off, nominal {before}"
        print(f"{what}: {most:.1e} m or rad from the calibrated robot; the nominal one up to {before:.1e}")


def check_compensated(robot):
    random = np.random.default_rng(8)
    listed = random.uniform(-0.4, 0.4, size=(30, 6)) + [0, -1.2, 1.4, -1, 1.3, 0]  # far from singular
    names = [joint for joint, moves, *_ in robot.chain if moves]
    (robot.folder / "list.csv").write_text(",".join(names) + "\n" + "".join(",".join(map(repr, map(float, q))) + "\n" for q in listed))
    robot.run("compensate", "calibrated.yaml", "list.csv", "-o", "commanded.csv", "--force")
    commanded = [line.split(",") for line in (robot.folder / "commanded.csv").read_text().splitlines() if re.match(r"-?\d", line)]
    most = max(np.abs(forward(robot.chain, [float(v) for v in u], robot.off) - forward(robot.chain, q)).max() for u, q in zip(commanded, listed, strict=True))
    assert most < 1e-9, most
    print(f"compensated poses: {most:.1e} m or rad from where the nominal robot stands")


def check_ur(folder):
    robot = Robot(folder, "ur10.urdf", ur_description(UR10), ur_description(UR10), 1)
    robot.run("compensate", "calibrated.yaml", "--ur-kinematics", "kinematics.yaml", "--urdf", "real.urdf")
    found = yaml.safe_load((folder / "kinematics.yaml").read_text())["kinematics"]
    rows = [[found[link][key] for key in ("x", "y", "z", "roll", "pitch", "yaw")] for link in LINKS]
    robot.same(chain_of(ur_description(rows)), "kinematics.yaml")
    robot.same(chain_of((folder / "real.urdf").read_text()), "URDF")
    check_compensated(robot)
    older = SOURCE.parent / "shared" / "robots" / "ur10" / "example-robot-data" / "robots" / "ur_description" / "urdf" / "ur10_robot.urdf"
    if not older.exists():
        print("the older UR10 is not there: not checked")
        return
    text = re.sub(r"<(visual|collision)>.*?</\1>", "", older.read_text(), flags=re.S)
    robot = Robot(folder, "ur10_older.urdf", text, text, 2)
    robot.run("compensate", "calibrated.yaml", "--urdf", "older.urdf")
    robot.same(chain_of((folder / "older.urdf").read_text()), "URDF of the older UR10")
    check_compensated(robot)
    refused = robot.run("compensate", "calibrated.yaml", "--ur-kinematics", "no.yaml", status=1)
    assert "'shoulder_lift_joint' does not turn about z" in refused.stderr and not (folder / "no.yaml").exists(), refused.stderr


XACRO = '''<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <!-- lengths of the data sheet -->
  <xacro:property name="reach" value="0.6"/>
  <xacro:macro name="arm" params="prefix">
    <link name="${prefix}base"/>
    LINKS
    <link name="tool0"/>
    <joint name="${prefix}end" type="fixed"><parent link="${prefix}l6"/><child link="tool0"/><origin xyz="0.1 0 ${reach / 4}"/></joint>
  </xacro:macro>
  <xacro:arm prefix="left_"/>
</robot>
'''


def provide_xacro(folder):
    """ROS's program, or one of its name that is npm's parser."""
    if shutil.which("xacro") is not None:
        print("xacro of ROS")
        return
    if shutil.which("node") is None or not (SOURCE / "report" / "node_modules" / "xacro-parser").exists():
        print("neither ROS's xacro nor npm's xacro-parser: not checked")
        sys.exit(77)
    tools = folder / "bin"
    tools.mkdir()
    (tools / "xacro").write_text(f'#!/bin/sh\nexec node "{SOURCE}/tests/cli/xacro.mjs" "$@"\n')
    (tools / "xacro").chmod(0o755)
    os.environ["PATH"] = f"{tools}:{os.environ['PATH']}"
    print("npm's xacro-parser in place of ROS's xacro")


def check_xacro(folder):
    provide_xacro(folder)
    links = ""
    for k, (origin, axis) in enumerate([("0 0 0.4", "0 0 1"), ("0.1 0 0", "0 1 0"), ("0 0 ${reach}", "0 1 0"), ("${reach / 2} 0 0.05", "1 0 0"),
                                        ("${reach / 2} 0 0", "0 1 0"), ("0.1 0 0", "1 0 0")]):
        parent = "${prefix}base" if k == 0 else f"${{prefix}}l{k}"
        links += (f'<link name="${{prefix}}l{k + 1}"/> <!-- axis {k + 1} -->\n    <joint name="${{prefix}}a{k + 1}" type="revolute"><parent link="{parent}"/>'
                  f'<child link="${{prefix}}l{k + 1}"/><origin xyz="{origin}" rpy="0 0 0"/><axis xyz="{axis}"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>\n    ')
    text = XACRO.replace("LINKS", links.strip())
    (folder / "arm.xacro").write_text(text)
    expanded = lambda name: subprocess.run(["xacro", name], cwd=folder, capture_output=True, text=True, check=True).stdout
    robot = Robot(folder, "arm.xacro", text, expanded("arm.xacro"), 3)
    robot.run("compensate", "calibrated.yaml", "--xacro", "real.xacro")
    real = (folder / "real.xacro").read_text()
    robot.same(chain_of(expanded("real.xacro")), "xacro file, expanded")
    kept = lambda what: re.sub(r"<origin [^>]*/>", "<origin/>", what)
    assert kept(real) == kept(text), "more than origins has changed"


with tempfile.TemporaryDirectory() as folder:
    {"ur": check_ur, "xacro": check_xacro}[WHICH](pathlib.Path(folder))
