"""ros2 launch depthgrid_ros cell.launch.py cell:=/path/to/cell.yaml"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("cell", description="the cell file; depthgrid cell new writes one"),
        DeclareLaunchArgument("namespace", default_value="", description="of the topics distances and markers"),
        Node(package="depthgrid_ros", executable="cell", name="cell", namespace=LaunchConfiguration("namespace"),
             parameters=[{"cell": LaunchConfiguration("cell")}], output="screen"),
    ])
