"""Node that drives FollowJointTrajectory through a route, stops at each pose and records what joints and targets read."""
from __future__ import annotations

import sys
import time
from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import PointStamped
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from posewright_measure.readings import Mean, Readings
from posewright_measure.stops import Motion, farthest, read_route

SUCCEEDED = 4  # action_msgs/GoalStatus
AT_START = 0.01  # rad or m: a motion begins where the route has it
PATIENCE = 5.0  # s for what ought to be there


class Stopped(Exception):
    """The robot is left where it is; the text says why."""


class Measure(Node):
    def __init__(self) -> None:
        super().__init__("posewright_measure")
        text = {name: self.declare_parameter(name, default).value for name, default in {
            "route": "route.json", "trajectory": "trajectory.yaml", "readings": "measured.csv", "topic": "/tracker/{target}",
            "action": "/joint_trajectory_controller/follow_joint_trajectory", "targets": "P1,P2,P3"}.items()}
        self.settle = float(self.declare_parameter("settle", 2.0).value)
        self.window = float(self.declare_parameter("window", 1.0).value)
        self.route = read_route(text["route"], text["trajectory"])
        targets = [target.strip() for target in text["targets"].split(",")]
        self.columns = [f"{target}.{axis}" for target in targets for axis in "xyz"]
        self.file = Readings(text["readings"], self.route.names, self.columns)
        self.joints: dict[str, float] = {}
        self.mean: Mean | None = None
        self.create_subscription(JointState, "/joint_states", self._joint_state, 10)
        for target in targets:
            self.create_subscription(PointStamped, text["topic"].format(target=target), self._point(target), 10)
        self.client = ActionClient(self, FollowJointTrajectory, text["action"])

    def _joint_state(self, message: Any) -> None:
        self.joints.update(zip(message.name, message.position))
        if self.mean is not None:
            for name, value in zip(message.name, message.position):
                self.mean.add(name, value)

    def _point(self, target: str) -> Any:
        def read(message: Any) -> None:
            if self.mean is not None:
                for axis in "xyz":
                    self.mean.add(f"{target}.{axis}", getattr(message.point, axis))
        return read

    def run(self) -> None:
        """The whole route. A pose that the file has already is driven to, since motions lead from stop to stop, but not read."""
        if not self.client.wait_for_server(timeout_sec=PATIENCE):
            raise Stopped("no controller offers the action")
        for number, motion in enumerate(self.route.motions, 1):
            self._drive(motion)
            if motion.pose and motion.pose not in self.file.measured:
                self._read(motion.pose)
            self.get_logger().info(f"pose {motion.pose}, motion {number} of {len(self.route.motions)}")

    def _drive(self, motion: Motion) -> None:
        self.wait(PATIENCE, until=lambda: set(self.route.names) <= set(self.joints))
        joint, distance = farthest(self.joints, self.route.names, motion.points[0])
        if distance > AT_START:
            raise Stopped(f"{joint} is {distance:.3g} rad or m from where the motion to pose {motion.pose} begins")
        goal = FollowJointTrajectory.Goal()
        goal.trajectory = JointTrajectory(joint_names=self.route.names, points=[
            JointTrajectoryPoint(positions=point, velocities=[0.0] * len(point), time_from_start=duration(seconds))
            for point, seconds in zip(motion.points[1:], motion.times[1:])])  # it stands at the first
        handle = self._finished(self.client.send_goal_async(goal), PATIENCE)
        if not handle.accepted:
            raise Stopped(f"the controller refuses the motion to pose {motion.pose}")
        try:
            answer = self._finished(handle.get_result_async(), motion.times[-1] + PATIENCE)
        except BaseException:  # Ctrl-C too: the robot must not move on by itself
            self._finished(handle.cancel_goal_async(), PATIENCE)
            raise
        if answer.status != SUCCEEDED or answer.result.error_code != 0:
            raise Stopped(f"the motion to pose {motion.pose} failed: {answer.result.error_string or answer.result.error_code}")

    def _finished(self, future: Any, seconds: float) -> Any:
        rclpy.spin_until_future_complete(self, future, timeout_sec=seconds)
        if not future.done():
            raise Stopped(f"the controller has not answered within {seconds:.0f} s")
        return future.result()

    def _read(self, pose: int) -> None:
        self.wait(self.settle)
        self.mean = Mean()
        self.wait(self.window)
        mean, self.mean = self.mean, None
        joints = [mean.value(name) for name in self.route.names]
        readings = [mean.value(name) for name in self.columns]
        if None in joints or all(value is None for value in readings):
            raise Stopped(f"nothing was read at pose {pose}: {'joints' if None in joints else 'targets'} are silent")
        self.file.add(pose, [value for value in joints if value is not None], readings)

    def wait(self, seconds: float, until: Any = lambda: False) -> None:
        """Messages are taken meanwhile."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            rclpy.spin_once(self, timeout_sec=0.05)


def duration(seconds: float) -> Any:
    nanoseconds = round(1e9 * seconds)
    return Duration(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def main() -> int:
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # Ctrl-C must find a context that can still cancel
    try:
        Measure().run()
    except (Stopped, ValueError, OSError, KeyError) as error:
        print(f"posewright_measure: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    finally:
        rclpy.try_shutdown()
    return 0
