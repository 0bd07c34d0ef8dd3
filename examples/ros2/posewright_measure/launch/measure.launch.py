"""ros2 launch posewright_measure measure.launch.py route:=route.json trajectory:=trajectory.yaml targets:=P1,P2,P3"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "route": (None, "route.json of `posewright route --from-home`"),
    "trajectory": (None, "the same route by `posewright export --to joint-trajectory`"),
    "targets": ("P1,P2,P3", "names of the targets in the problem file, with commas"),
    "readings": ("measured.csv", "file that the readings are appended to"),
    "action": ("/joint_trajectory_controller/follow_joint_trajectory", "of the robot's controller"),
    "topic": ("/tracker/{target}", "geometry_msgs/PointStamped of each target, m, in the instrument's frame"),
    "settle": ("2.0", "s at rest before the readings"),
    "window": ("1.0", "s of readings that are averaged"),
}


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, description=text) if default is None
                else DeclareLaunchArgument(name, default_value=default, description=text)
                for name, (default, text) in ARGUMENTS.items()]
    node = Node(package="posewright_measure", executable="measure", output="screen",
                parameters=[{name: LaunchConfiguration(name) for name in ARGUMENTS}])
    return LaunchDescription([*declared, node])
