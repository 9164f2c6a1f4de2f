"""The shapes of a simulated world, where `gazebo/model_states` says that they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gazebo_msgs.msg import ModelStates
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.description.link import Visual
from daidalos.description.world import Model
from daidalos.interfaces.library import BUILT_IN
from daidalos.nodes.packages import package_share

_DEFAULT = "worlds/cell.world"


@dataclass(frozen=True)
class CellParameters(Parameters):
    """Parameters of nodes that know the cell."""

    world: str = parameter("", "The world's SDF file; that of the demonstration where empty.")


class Cell:
    """Models of a world's file at the poses that the simulator publishes.

    Parameters
    ----------
    node : Node
        That listens to ``gazebo/model_states``.
    world : str
        The world's SDF file; that of the demonstration where empty.
    """

    def __init__(self, node: Node, world: str) -> None:
        file = Path(world) if world else BUILT_IN / "daidalos_lighting" / _DEFAULT
        loaded = sdf.load(file, resolve=package_share)
        self._models: Mapping[str, Model] = {placed.name: placed for placed in loaded.models}
        self._poses: dict[str, Pose] = {}
        node.create_subscription(ModelStates, "gazebo/model_states", self._take, 1)

    def visuals(self) -> Iterator[tuple[str, int, Pose, Visual]]:
        """Yield model, number, pose in the world and look of each shape; what was spawned later is not of the file."""
        for name, pose in self._poses.items():
            model = self._models.get(name)
            links = model.links.values() if model is not None else ()
            placed = [(link.pose @ visual.pose, visual) for link in links for visual in link.visuals]
            for number, (place, visual) in enumerate(placed):
                yield name, number, pose @ place, visual

    def _take(self, states: ModelStates) -> None:
        self._poses = {name: _pose(pose) for name, pose in zip(states.name, states.pose, strict=True)}


def _pose(pose: Any) -> Pose:
    position, turn = pose.position, pose.orientation
    return Pose((position.x, position.y, position.z), (turn.x, turn.y, turn.z, turn.w))
