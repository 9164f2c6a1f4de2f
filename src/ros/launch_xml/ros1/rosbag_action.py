"""The action that runs `ros2 bag` for a node of ROS 1's package `rosbag`."""

from __future__ import annotations

import shlex
import signal
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch.actions import EmitEvent, ExecuteProcess, TimerAction
from launch.events import matches_action
from launch.events.process import SignalProcess
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.utilities import make_namespace_absolute, prefix_namespace

from .rosbag import BagCommand, ros2_command

if TYPE_CHECKING:
    from launch import LaunchContext


class Rosbag(ExecuteProcess):
    """Action that records or plays a bag; its command line is translated when its substitutions have been performed.

    Parameters
    ----------
    verb
        ``record`` or ``play``.
    command_line
        What followed the verb.
    namespace
        Where relative names of topics begin, inside the namespace of the present scope.
    remappings
        Pairs of names.
    **kwargs
        As for `launch.actions.ExecuteProcess`.
    """

    def __init__(
        self,
        *,
        verb: str,
        command_line: SomeSubstitutionsType = "",
        namespace: SomeSubstitutionsType = "",
        remappings: Sequence[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] = (),
        **kwargs: Any,
    ) -> None:
        super().__init__(cmd=["ros2", "bag"], **kwargs)
        self.__verb = verb
        self.__command_line = command_line
        self.__namespace = namespace
        self.__remappings = remappings

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the process, and say what it does and what it leaves out."""
        command = self.__translate(context)
        arguments = command.arguments
        if self.__verb == "record" and ("use_sim_time", True) in context.launch_configurations.get("global_params", []):
            arguments = [*arguments, "--use-sim-time"]
        logger = get_logger("launch.ros1")
        logger.info(f"rosbag {self.__verb} -> {shlex.join(['ros2', 'bag', *arguments])}")
        for note in command.notes:
            logger.warning(f"rosbag {self.__verb}: {note}")
        self.process_description.cmd.extend(normalize_to_list_of_substitutions(word) for word in arguments)
        entities = super().execute(context) or []
        if command.duration_s is None:
            return entities
        end = SignalProcess(signal_number=signal.SIGINT, process_matcher=matches_action(self))
        return [*entities, TimerAction(period=command.duration_s, actions=[EmitEvent(event=end)])]

    def __translate(self, context: LaunchContext) -> BagCommand:
        words = shlex.split(_perform(context, self.__command_line))
        outside = context.launch_configurations.get("ros_namespace")
        namespace = make_namespace_absolute(prefix_namespace(outside, _perform(context, self.__namespace)) or "")
        own = [(_perform(context, old), _perform(context, new)) for old, new in self.__remappings]
        try:
            return ros2_command(
                self.__verb, words, namespace, [*context.launch_configurations.get("ros_remaps", []), *own]
            )
        except ValueError as error:
            raise SubstitutionFailure(str(error)) from None


def _perform(context: LaunchContext, text: SomeSubstitutionsType) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(text))
