"""Several TurtleBot3 in one world, each with mapping and navigation in a namespace and with transforms of its own.

Each one gets a goal ahead of it once its navigation should be active.
"""

import math

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, TimerAction
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode, ParameterFile
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

from daidalos.common.temporary_files import write_temporary

COMMANDS = [("cmd_vel", "cmd_vel_nav")]
SERVERS = [
    ("nav2_controller", "nav2_controller::ControllerServer", "controller_server", COMMANDS),
    ("nav2_planner", "nav2_planner::PlannerServer", "planner_server", []),
    ("nav2_behaviors", "behavior_server::BehaviorServer", "behavior_server", COMMANDS),
    ("nav2_velocity_smoother", "nav2_velocity_smoother::VelocitySmoother", "velocity_smoother", COMMANDS),
    ("nav2_collision_monitor", "nav2_collision_monitor::CollisionMonitor", "collision_monitor", []),
    ("nav2_bt_navigator", "nav2_bt_navigator::BtNavigator", "bt_navigator", []),
]
MANAGED = {"autostart": True, "node_names": [name for _, _, name, _ in SERVERS]}
START = 5.0
SIMULATED = {"use_sim_time": True}
AHEAD = "{{pose: {{header: {{frame_id: map}}, pose: {{position: {{x: {:g}}}, orientation: {{w: 1.0}}}}}}}}"


GROUND = """<model name="ground_plane"><static>true</static><link name="link"><collision name="collision">
  <geometry><plane><normal>0 0 1</normal><size>200 200</size></plane></geometry></collision></link></model>"""
PILLAR = """<model name="pillar{}"><static>true</static><pose>{:g} {:g} 0.5 0 0 0</pose><link name="link">
  <collision name="collision"><geometry><box><size>0.3 0.3 1</size></box></geometry></collision></link></model>"""


def write_world(places, spacing):
    """Write a world with two pillars ahead of each robot, so that its map covers the goal, and return its path."""
    ahead = [(x + 0.75 * spacing, y + side * spacing) for x, y in places for side in (-0.25, 0.25)]
    pillars = [PILLAR.format(number, x, y) for number, (x, y) in enumerate(ahead)]
    path = write_temporary(
        f'<sdf version="1.6"><world name="fleet">{GROUND}{"".join(pillars)}</world></sdf>', "fleet-", ".world"
    )
    return str(path)


def share(package, *parts):
    return PathJoinSubstitution([FindPackageShare(package), *parts])


def parameters_of(name, *path):
    return ParameterFile(RewrittenYaml(share(*path), param_rewrites={}, root_key=name, convert_types=True))


def robot(name, x, y, description, distance):
    own = [(f"/{topic}", f"/{name}/{topic}") for topic in ("tf", "tf_static", "scan", "map", "odom", "cmd_vel")]
    navigation = parameters_of(name, "nav2_bringup", "params", "nav2_params.yaml")
    mapping = parameters_of(name, "slam_toolbox", "config", "mapper_params_online_async.yaml")
    servers = [
        ComposableNode(
            package=package,
            plugin=plugin,
            name=node,
            namespace=name,
            parameters=parameters,
            remappings=[*own, *remappings],
        )
        for package, plugin, node, remappings, parameters in (
            ("slam_toolbox", "slam_toolbox::AsynchronousSlamToolbox", "slam_toolbox", [], [mapping, SIMULATED]),
            *((*server, [navigation]) for server in SERVERS),
            (
                "nav2_lifecycle_manager",
                "nav2_lifecycle_manager::LifecycleManager",
                "lifecycle_manager_navigation",
                [],
                [navigation, MANAGED],
            ),
        )
    ]
    goal = AHEAD.format(distance)
    send = ["ros2", "action", "send_goal", f"/{name}/navigate_to_pose", "nav2_msgs/action/NavigateToPose", goal]
    return [
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            namespace=name,
            parameters=[{"robot_description": ParameterValue(description, value_type=str)}, SIMULATED],
            remappings=own,
        ),
        Node(
            package="gazebo_ros",
            executable="spawn_entity.py",
            arguments=[
                *("-topic", f"/{name}/robot_description", "-entity", name, "-robot_namespace", name),
                *("-x", f"{x:g}", "-y", f"{y:g}", "-z", "0.01"),
            ],
        ),
        ComposableNodeContainer(
            name="nav2_container",
            namespace=name,
            package="rclcpp_components",
            executable="component_container_isolated",
            parameters=[navigation],
            remappings=own,  # for the costmaps, which the servers create in it
            composable_node_descriptions=servers,
            output="screen",
        ),
        TimerAction(period=START, actions=[ExecuteProcess(cmd=send, name=f"goal_of_{name}", output="screen")]),
    ]


def robots(context):
    model = share("turtlebot3_description", "urdf", "turtlebot3_waffle.urdf.xacro")
    # All of them share one description.
    description = Command([FindExecutable(name="xacro"), " ", model, " tf_topic:=tf"]).perform(context)
    count = int(LaunchConfiguration("robots").perform(context))
    spacing = float(LaunchConfiguration("spacing").perform(context))
    columns = math.ceil(math.sqrt(count))
    places = [(spacing * (number % columns), spacing * (number // columns)) for number in range(count)]
    simulator = Node(
        package="gazebo_ros",
        executable="gzserver",
        arguments=[LaunchConfiguration("world").perform(context) or write_world(places, spacing)],
        parameters=[{"seed": ParameterValue(LaunchConfiguration("seed"), value_type=int)}],
        output="screen",
    )
    return [
        simulator,
        *(
            action
            for number, place in enumerate(places)
            for action in robot(f"robot{number}", *place, description, 0.5 * spacing)
        ),
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2", description="how many"),
            DeclareLaunchArgument("spacing", default_value="3.0", description="between them [m]"),
            DeclareLaunchArgument(
                "world", default_value="", description="SDF world to simulate; pillars on a plane by default"
            ),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            OpaqueFunction(function=robots),
        ]
    )
