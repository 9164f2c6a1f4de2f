"""One of slam_toolbox's nodes, configured and activated."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.events import matches_action
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from lifecycle_msgs.msg import Transition


def generate_launch_description():
    is_managed = LaunchConfiguration("use_lifecycle_manager")
    starts_itself = IfCondition(AndSubstitution(LaunchConfiguration("autostart"), NotSubstitution(is_managed)))
    node = LifecycleNode(
        package="slam_toolbox",
        executable=LaunchConfiguration("executable"),
        name="slam_toolbox",
        namespace="",
        parameters=[
            LaunchConfiguration("slam_params_file"),
            {
                "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
                "use_lifecycle_manager": ParameterValue(is_managed, value_type=bool),
            },
        ],
        output="screen",
    )

    def change(transition, condition=None):
        return EmitEvent(
            event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition),
            condition=condition,
        )

    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="whether time is simulated"),
            DeclareLaunchArgument("executable", description="executable of slam_toolbox"),
            DeclareLaunchArgument("slam_params_file", description="parameter file"),
            DeclareLaunchArgument("autostart", default_value="true", description="whether the node is activated"),
            DeclareLaunchArgument(
                "use_lifecycle_manager", default_value="false", description="whether a lifecycle manager activates it"
            ),
            node,
            RegisterEventHandler(
                OnStateTransition(
                    target_lifecycle_node=node,
                    start_state="configuring",
                    goal_state="inactive",
                    entities=[change(Transition.TRANSITION_ACTIVATE)],
                ),
                condition=starts_itself,  # evaluated here: the handler runs outside of the scope of an include
            ),
            change(Transition.TRANSITION_CONFIGURE, starts_itself),
        ]
    )
