"""The example's node, without ROS: in a world where a robot follows trajectories and a tracker reads what `simulate` has
drawn for each pose, its file gives the calibration that simulate's own file gives. Argument: PROGRAM."""
from __future__ import annotations

import csv
import importlib.util
import json
import math
import pathlib
import py_compile
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
EXAMPLE = ROOT / "examples/ros2/posewright_measure"
sys.path[:0] = [str(HERE / "standins"), str(EXAMPLE)]
sys.dont_write_bytecode = True

import rclpy
import rclpy.action
import rclpy.node
from geometry_msgs.msg import Point, PointStamped
from posewright_measure import measure
from posewright_measure.readings import Readings
from posewright_measure.stops import read_route
from sensor_msgs.msg import JointState

PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
PROBLEM = ROOT / "examples/kr270/problem.yaml"
ACTION = "/joint_trajectory_controller/follow_joint_trajectory"


class Answer:
    def __init__(self, status, error_code=0, error_string=""):
        self.status, self.result = status, self
        self.error_code, self.error_string = error_code, error_string


class World:
    """A robot that takes one turn for each trajectory, and a tracker that reads at the poses of a data file."""

    def __init__(self, data, home):
        rows = list(csv.DictReader(data.read_text().splitlines()))
        self.joints = [name for name in rows[0] if name.startswith("joint_")]
        self.targets = sorted({name.split(".")[0] for name in rows[0] if name.startswith("P")})
        self.rows = [{name: float(value) for name, value in row.items() if value and name not in ("use",)} for row in rows]
        self.at, self.goals, self.waiting, self.canceled = list(home), [], None, 0
        self.fails_at, self.silent, self.turn = None, False, 0

    # The controller.
    def accept(self, goal):
        names, points = goal.trajectory.joint_names, goal.trajectory.points
        assert [f"{name} [rad]" for name in names] == self.joints
        times = [0.0] + [point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec for point in points]
        assert all(b > a for a, b in zip(times, times[1:])), "times do not grow"
        assert all(len(point.positions) == len(point.velocities) == len(names) for point in points)
        self.goals.append(goal)
        self.waiting = rclpy.action.Future(done=False)
        return self

    accepted = True

    def get_result_async(self):
        return self.waiting

    def cancel_goal_async(self):
        self.canceled += 1
        return rclpy.action.Future()

    # A turn of the world.
    def __call__(self, node):
        self.turn += 1
        if self.waiting is not None and not self.waiting.done():
            if self.fails_at == len(self.goals):
                self.waiting.set_result(Answer(6, -4, "path tolerance violated"))
            elif self.fails_at != -len(self.goals):  # negative: it never answers
                self.at = list(self.goals[-1].trajectory.points[-1].positions)
                self.waiting.set_result(Answer(4))
        jitter = 1e-6 * (-1) ** self.turn
        kind, take = node.topics["/joint_states"]
        take(kind(name=[name.split()[0] for name in reversed(self.joints)], position=[q + jitter for q in reversed(self.at)]))
        # A route may have joints on another turn than the plan.
        near = lambda row: all(abs(math.remainder(row[name] - q, math.tau)) < 1e-6 for name, q in zip(self.joints, self.at))
        row = next(filter(near, self.rows), None)
        for target in self.targets if row and not self.silent else []:
            kind, take = node.topics[f"/tracker/{target}"]
            take(kind(point=Point(**{axis: row[f"{target}.{axis} [m]"] + jitter for axis in "xyz"})))


class Node(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        quick = ["--candidates", "60", "--method", "greedy"]
        cls.run_program("plan", PROBLEM, *quick, "-o", "plan.json", "--poses-csv", "poses.csv")
        cls.run_program("route", "plan.json", "--from-home", "--closed", "--milestones", "50", "-o", "route.json")
        cls.run_program("export", "route.json", "--to", "joint-trajectory", "-o", "trajectory.yaml")
        cls.run_program("simulate", PROBLEM, "plan.json", "--draws", "2", "--data", "drawn.csv")
        cls.route = json.loads((cls.folder / "route.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def run_program(cls, *words):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=cls.folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def start(self, readings="measured.csv", **changed):
        self.world = World(self.folder / "drawn.csv", self.route["home"])
        rclpy.worlds[:] = [self.world]
        rclpy.action.servers = {ACTION: self.world}
        rclpy.node.given = {name: str(self.folder / file) for name, file in
                            {"route": "route.json", "trajectory": "trajectory.yaml", "readings": readings}.items()}
        rclpy.node.given |= {"settle": "0.0", "window": "0.002", **changed}
        return measure.Measure()

    def lines(self, readings):
        return list(csv.reader((self.folder / readings).read_text().splitlines()))

    def test_readings_of_the_route_give_the_calibration_of_the_drawn_readings(self):
        self.start().run()
        self.assertEqual([int(line[0]) for line in self.lines("measured.csv")[1:]], self.route["order"])
        self.assertEqual(len(self.world.goals), len(self.route["motions"]))
        values = {}
        for name in ("measured.csv", "drawn.csv"):
            said = json.loads(self.run_program("calibrate", PROBLEM, name, "-o", "-", "--json"))
            values[name] = {p["name"]: (p["value"], p["sigma"]) for p in said["parameters"] if p["estimated"]}
        self.assertGreater(len(values["drawn.csv"]), 20)
        for name, (value, sigma) in values["drawn.csv"].items():
            self.assertLess(abs(values["measured.csv"][name][0] - value), 0.2 * sigma, name)

    def test_motions_end_where_the_next_one_begins_and_visit_every_point_of_the_route(self):
        route = read_route(str(self.folder / "route.json"), str(self.folder / "trajectory.yaml"))
        self.assertEqual([motion.pose for motion in route.motions], [motion["to"] for motion in self.route["motions"]])
        for before, after in zip(route.motions, route.motions[1:]):
            self.assertEqual(before.points[-1], after.points[0])
            self.assertEqual(before.times[0], 0)

    def test_a_failed_motion_stops_the_robot_and_a_second_start_goes_on(self):
        node = self.start("again.csv")
        self.world.fails_at = 5
        with self.assertRaisesRegex(measure.Stopped, f"pose {self.route['order'][4]} failed: path tolerance violated"):
            node.run()
        self.assertEqual(len(self.world.goals), 5)
        self.assertEqual([int(line[0]) for line in self.lines("again.csv")[1:]], self.route["order"][:4])
        self.start("again.csv").run()
        self.assertEqual([int(line[0]) for line in self.lines("again.csv")[1:]], self.route["order"])

    def test_a_motion_without_end_is_canceled(self):
        node = self.start("late.csv")
        self.world.fails_at = -2
        with self.assertRaisesRegex(measure.Stopped, "has not answered"):
            node.run()
        self.assertEqual(self.world.canceled, 1)

    def test_nothing_moves_from_another_place_than_home(self):
        node = self.start("away.csv")
        self.world.at[2] += 0.1
        with self.assertRaisesRegex(measure.Stopped, "joint_a3 is 0.1 rad or m from where the motion"):
            node.run()
        self.assertEqual(self.world.goals, [])

    def test_silent_targets_are_no_reading(self):
        node = self.start("silent.csv")
        self.world.silent = True
        with self.assertRaisesRegex(measure.Stopped, "nothing was read at pose .*: targets are silent"):
            node.run()
        self.assertEqual(len(self.lines("silent.csv")), 1)

    def test_files_that_do_not_belong_together_are_named(self):
        other = self.folder / "other.yaml"
        text = (self.folder / "trajectory.yaml").read_text()
        other.write_text(re.sub(r"positions: \[0\.0, ", "positions: [0.5, ", text, count=1))
        with self.assertRaisesRegex(ValueError, "other.yaml: point 1 is not where the motion to pose"):
            self.start("other.csv", trajectory=str(other))
        other.write_text(text.replace("joint_a1", "elbow"))
        with self.assertRaisesRegex(ValueError, "moves elbow"):
            self.start("other.csv", trajectory=str(other))
        broken = self.folder / "broken.csv"
        Readings(str(broken), ["joint_a1"], ["P1.x"]).add(3, [0.5], [None])
        self.assertEqual(broken.read_text(), "id,joint_a1 [rad],P1.x [m]\n3,0.5,\n")
        with broken.open("a") as file:
            file.write("4,0.25")
        with self.assertRaisesRegex(ValueError, "broken.csv:3: 2 values, not 3"):
            Readings(str(broken), ["joint_a1"], ["P1.x"])
        with self.assertRaisesRegex(ValueError, "has other columns"):
            Readings(str(broken), ["joint_a1"], ["P2.x"])

    def test_the_launch_file_starts_what_the_package_installs_with_parameters_that_the_node_has(self):
        spec = importlib.util.spec_from_file_location("measure_launch", EXAMPLE / "launch/measure.launch.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        *declared, node = module.generate_launch_description().entities
        self.assertEqual((node.package, node.executable), ("posewright_measure", "measure"))
        setup = (EXAMPLE / "setup.py").read_text()
        self.assertIn("f\"measure = {NAME}.measure:main\"", setup)
        self.assertIn("launch/measure.launch.py", setup)
        asked = set()

        class Recording(dict):
            def get(self, name, default=None):
                asked.add(name)
                return super().get(name, default)

        self.start("launched.csv")
        rclpy.node.given = Recording(rclpy.node.given)
        measure.Measure()
        self.assertEqual(set(node.parameters[0]), asked)
        self.assertEqual({argument.name for argument in declared}, asked)

    def test_types_pass_mypy(self):
        if importlib.util.find_spec("mypy") is None:
            self.skipTest("mypy is missing (Debian: python3-mypy)")
        done = subprocess.run(
            # (yaml has no stubs in Debian 12)
            [sys.executable, "-m", "mypy", "--strict", "--allow-any-generics", "--disable-error-code", "import", "--cache-dir", str(self.folder / "mypy"),
             "-p", "posewright_measure"], cwd=HERE, env={"MYPYPATH": f"{HERE / 'standins'}:{EXAMPLE}", "PATH": "/usr/bin:/bin"}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_file_compiles(self):
        for file in EXAMPLE.rglob("*.py"):
            py_compile.compile(str(file), cfile=str(self.folder / "compiled"), doraise=True)


if __name__ == "__main__":
    unittest.main(verbosity=1)
