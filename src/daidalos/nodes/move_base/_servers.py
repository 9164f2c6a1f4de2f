"""The servers of Nav2 that `move_base` runs, in its own namespace."""

from __future__ import annotations

from typing import Any

import yaml
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node

from daidalos.common.errors import UserError
from daidalos.common.temporary_files import write_temporary
from daidalos.nodes.move_base._translation import Translation
from daidalos.nodes.nav2_behaviors.behavior_server import BehaviorServer
from daidalos.nodes.nav2_controller.controller_server import ControllerServer
from daidalos.nodes.nav2_planner.planner_server import PlannerServer
from daidalos.nodes.node_thread import NodeThread


class Servers:
    """Planner, controller and behaviour server below a node's name, each spun in a thread of its own.

    Parameters
    ----------
    node : Node
        Where velocities, odometry and transforms are, and the time.
    translation : Translation
        Their parameters.

    Raises
    ------
    UserError
        One of them cannot be configured; it has said why.
    """

    def __init__(self, node: Node, translation: Translation) -> None:
        below = node.get_fully_qualified_name()
        is_simulated = bool(node.get_parameter("use_sim_time").value)
        values = {
            f"{below}/{name}": {"ros__parameters": {"use_sim_time": is_simulated, **given}}
            for name, given in translation.nodes.items()
        }
        self._file = write_temporary(yaml.safe_dump(values), "move_base_", ".yaml")
        arguments = ["--params-file", str(self._file)]
        velocity = ["-r", f"cmd_vel:={node.resolve_topic_name('cmd_vel')}"]
        transforms = [
            one for topic in ("/tf", "/tf_static") for one in ("-r", f"{topic}:={node.resolve_topic_name(topic)}")
        ]
        planner, controller = (name.replace("::", "/").rsplit("/", 1)[-1] for name in (
            translation.planner, translation.controller))  # fmt: skip
        odometry = ["-r", f"odom:={node.resolve_topic_name('odom')}"]
        self._nodes: list[Any] = []
        self._threads: list[NodeThread] = []
        try:
            for make, more in (
                (PlannerServer, ["-r", f"plan:={below}/{planner}/plan"]),
                (ControllerServer, [*velocity, "-r", f"local_plan:={below}/{controller}/local_plan"]),
                (BehaviorServer, [*velocity, *odometry]),
            ):
                name = make.__name__
                named = {"PlannerServer": "planner_server", "ControllerServer": "controller_server"}.get(
                    name, "behavior_server"
                )
                options: dict[str, Any] = {"costmap_arguments": arguments} if make is not BehaviorServer else {}
                server = make(
                    named,
                    namespace=below,
                    context=node.context,
                    cli_args=["-r", f"{named}:__node:={named}", "-r", f"{named}:__ns:={below}", *arguments, *transforms,
                              *more],
                    **options,
                )  # fmt: skip
                self._nodes.append(server)
                self._threads.append(NodeThread(server))
            for step in ("trigger_configure", "trigger_activate"):
                for server in self._nodes:
                    if getattr(server, step)() != TransitionCallbackReturn.SUCCESS:
                        raise UserError(f"{node.get_name()} cannot start, as its {server.get_name()} does not")
        except BaseException:
            self.destroy()
            raise

    def destroy(self) -> None:
        """Stop the robot and destroy the servers."""
        for thread, server in zip(self._threads, self._nodes, strict=False):
            thread.stop()
            server.destroy_node()
        self._threads, self._nodes = [], []
        self._file.unlink(missing_ok=True)
