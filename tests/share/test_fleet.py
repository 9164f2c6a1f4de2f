"""Several robots of the demonstration: topics of each one's own, and what its launch file starts."""

from launch import LaunchContext
from launch.actions import TimerAction
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch_ros.actions import ComposableNodeContainer, Node

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.simulation import Simulation
from description.robots import SHARE, share_of

WAFFLE = SHARE / "turtlebot3_description/urdf/turtlebot3_waffle.urdf.xacro"


def test_transforms_of_robots_in_namespaces_do_not_mix() -> None:
    simulation = Simulation()
    for number, arguments in enumerate(({"tf_topic": "tf"}, {"tf_topic": "tf"}, {})):
        robot = urdf.load(WAFFLE, arguments, share_of)
        simulation.spawn(robot, f"robot{number}", Pose((float(number), 0.0, 0.01)), f"robot{number}")
    transforms = {topic for topic in simulation.publications if topic.endswith("/tf")}
    assert transforms == {"/robot0/tf", "/robot1/tf", "/tf"}


def test_the_launch_file_starts_each_robot_with_navigation() -> None:
    source = AnyLaunchDescriptionSource(str(SHARE / "daidalos_demo/launch/fleet.launch.py"))
    context = LaunchContext()
    context.launch_configurations["robots"] = "3"
    actions = []
    for entity in source.get_launch_description(context).entities:
        actions += entity.visit(context) or []
    containers = [action for action in actions if isinstance(action, ComposableNodeContainer)]
    nodes = [action for action in actions if isinstance(action, Node) and action not in containers]
    goals = [action for action in actions if isinstance(action, TimerAction)]
    assert (len(containers), len(nodes), len(goals)) == (3, 7, 3)  # the simulator, publishers of states, spawners
