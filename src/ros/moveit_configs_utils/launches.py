"""Launch descriptions of a robot's configuration package."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg, add_debuggable_node


def generate_rsp_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of the robot state publisher."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("publish_frequency", default_value="15.0"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                respawn=True,
                output="screen",
                parameters=[
                    moveit_config.robot_description,
                    {"publish_frequency": LaunchConfiguration("publish_frequency")},
                ],
            ),
        ]
    )


def generate_moveit_rviz_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of RViz with config/moveit.rviz."""
    description = LaunchDescription(
        [
            DeclareBooleanLaunchArg("debug", default_value=False),
            DeclareLaunchArgument("rviz_config", default_value=str(moveit_config.package_path / "config/moveit.rviz")),
        ]
    )
    add_debuggable_node(
        description,
        package="rviz2",
        executable="rviz2",
        output="log",
        respawn=False,
        arguments=["-d", LaunchConfiguration("rviz_config")],
        parameters=[
            moveit_config.planning_pipelines,
            moveit_config.robot_description_kinematics,
            moveit_config.joint_limits,
        ],
    )
    return description


def generate_setup_assistant_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of MoveIt's assistant."""
    description = LaunchDescription([DeclareBooleanLaunchArg("debug", default_value=False)])
    add_debuggable_node(
        description,
        package="moveit_setup_assistant",
        executable="moveit_setup_assistant",
        arguments=[f"--config_pkg={moveit_config.package_path}"],
    )
    return description


def generate_static_virtual_joint_tfs_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of a static transform for each virtual joint of the SRDF."""
    semantic = next(iter(moveit_config.robot_description_semantic.values()))
    joints = ElementTree.fromstring(semantic).iter("virtual_joint")
    return LaunchDescription(
        [
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                name=f"static_transform_publisher{number}",
                output="log",
                arguments=[
                    "--frame-id",
                    joint.get("parent_frame", ""),
                    "--child-frame-id",
                    joint.get("child_link", ""),
                ],
            )
            for number, joint in enumerate(joints)
        ]
    )


def generate_spawn_controllers_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of a spawner for each controller of the trajectory execution, and the broadcaster."""
    manager = moveit_config.trajectory_execution.get("moveit_simple_controller_manager", {})
    names = [*manager.get("controller_names", []), "joint_state_broadcaster"]
    return LaunchDescription(
        [Node(package="controller_manager", executable="spawner", arguments=[name], output="screen") for name in names]
    )


def generate_warehouse_db_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of MoveIt's data base."""
    path = moveit_config.package_path / "default_warehouse_mongo_db"
    parameters = {
        "overwrite": False,
        "database_path": LaunchConfiguration("moveit_warehouse_database_path"),
        "warehouse_port": LaunchConfiguration("warehouse_port", default="33829"),
        "warehouse_host": LaunchConfiguration("warehouse_host", default="localhost"),
        "warehouse_exec": "mongod",
        "warehouse_plugin": "warehouse_ros_mongo::MongoDatabaseConnection",
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("moveit_warehouse_database_path", default_value=str(path)),
            DeclareBooleanLaunchArg("reset", default_value=False),
            Node(package="warehouse_ros_mongo", executable="mongo_wrapper_ros.py", parameters=[parameters]),
            Node(
                package="moveit_ros_warehouse",
                executable="moveit_init_demo_warehouse",
                output="screen",
                condition=IfCondition(LaunchConfiguration("reset")),
            ),
        ]
    )


def generate_move_group_launch(moveit_config: Any) -> LaunchDescription:
    """Return the launch of MoveIt's node `move_group`."""
    capabilities = moveit_config.move_group_capabilities
    description = LaunchDescription(
        [
            DeclareBooleanLaunchArg("debug", default_value=False),
            DeclareBooleanLaunchArg("allow_trajectory_execution", default_value=True),
            DeclareBooleanLaunchArg("publish_monitored_planning_scene", default_value=True),
            DeclareLaunchArgument("capabilities", default_value=capabilities["capabilities"]),
            DeclareLaunchArgument("disable_capabilities", default_value=capabilities["disable_capabilities"]),
            DeclareBooleanLaunchArg("monitor_dynamics", default_value=False),
        ]
    )
    published = LaunchConfiguration("publish_monitored_planning_scene")
    parameters = {
        "publish_robot_description_semantic": True,
        "allow_trajectory_execution": LaunchConfiguration("allow_trajectory_execution"),
        # Texts, which may be empty.
        "capabilities": ParameterValue(LaunchConfiguration("capabilities"), value_type=str),
        "disable_capabilities": ParameterValue(LaunchConfiguration("disable_capabilities"), value_type=str),
        "publish_planning_scene": published,
        "publish_geometry_updates": published,
        "publish_state_updates": published,
        "publish_transforms_updates": published,
        "monitor_dynamics": LaunchConfiguration("monitor_dynamics"),
    }
    add_debuggable_node(
        description,
        package="moveit_ros_move_group",
        executable="move_group",
        commands_file=str(moveit_config.package_path / "launch" / "gdb_settings.gdb"),
        output="screen",
        parameters=[moveit_config.to_dict(), parameters],
        extra_debug_args=["--debug"],
        additional_env={"DISPLAY": os.environ.get("DISPLAY", "")},
    )
    return description


def generate_demo_launch(moveit_config: Any, launch_package_path: Path | None = None) -> LaunchDescription:
    """Return the launch of everything: transforms, robot state publisher, move_group, RViz and controllers.

    Parameters
    ----------
    moveit_config
        The configuration.
    launch_package_path
        Share folder of the package with the launch files and config/ros2_controllers.yaml; that of the
        configuration where None.
    """
    package = launch_package_path or moveit_config.package_path
    description = LaunchDescription(
        [
            DeclareBooleanLaunchArg("db", default_value=False, description="Whether to start the data base"),
            DeclareBooleanLaunchArg("debug", default_value=False, description="Whether to run nodes in gdb"),
            DeclareBooleanLaunchArg("use_rviz", default_value=True),
        ]
    )

    def include(name: str, argument: str | None = None) -> None:
        path = package / "launch" / f"{name}.launch.py"
        condition = IfCondition(LaunchConfiguration(argument)) if argument else None
        source = PythonLaunchDescriptionSource(str(path))
        description.add_action(IncludeLaunchDescription(source, condition=condition))

    if (package / "launch/static_virtual_joint_tfs.launch.py").exists():
        include("static_virtual_joint_tfs")
    include("rsp")
    include("move_group")
    include("moveit_rviz", "use_rviz")
    include("warehouse_db", "db")
    description.add_action(
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[str(moveit_config.package_path / "config/ros2_controllers.yaml")],
            remappings=[("/controller_manager/robot_description", "/robot_description")],
        )
    )
    include("spawn_controllers")
    return description
