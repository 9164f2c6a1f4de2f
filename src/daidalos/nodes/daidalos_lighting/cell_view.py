"""`cell_view`: the boxes, cylinders and spheres of a simulated world as markers, beside the robot in the 3-D view."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gazebo_msgs.msg import ModelStates
from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.description.geometry import Box, Cylinder, Geometry, Sphere
from daidalos.description.world import Model
from daidalos.interfaces.library import BUILT_IN
from daidalos.nodes.packages import package_share
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_DEFAULT = "worlds/cell.world"
_GREY = (0.6, 0.6, 0.6, 1.0)


@dataclass(frozen=True)
class CellViewParameters(Parameters):
    """Parameters of ``cell_view``."""

    world: str = parameter("", "The world's SDF file; that of the demonstration where empty.")
    rate: float = parameter(5.0, "How often the markers are published.", unit="Hz", above=0.0)


class CellView(Node):
    """Node that publishes ``cell/markers`` of the world's models where ``gazebo/model_states`` says they are."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("cell_view", **kwargs)
        settings = declare(self, CellViewParameters)
        file = Path(settings.world) if settings.world else BUILT_IN / "daidalos_lighting" / _DEFAULT
        world = sdf.load(file, resolve=package_share)
        self._models: Mapping[str, Model] = {placed.name: placed for placed in world.models}
        self._poses: dict[str, Pose] = {}
        self._markers = self.create_publisher(MarkerArray, "cell/markers", 1)
        self.create_subscription(ModelStates, "gazebo/model_states", self._take, 1)
        self.create_timer(1.0 / settings.rate, self._publish)

    def _take(self, states: ModelStates) -> None:
        self._poses = {name: _pose(pose) for name, pose in zip(states.name, states.pose, strict=True)}

    def _publish(self) -> None:
        if self._markers.get_subscription_count():
            found = (one for name, pose in self._poses.items() for one in self._draw(name, pose))
            self._markers.publish(MarkerArray(markers=list(found)))

    def _draw(self, name: str, pose: Pose) -> Iterator[Marker]:
        """Yield the markers of a model of the file; what was spawned later is drawn as a robot."""
        model = self._models.get(name)
        links = model.links.values() if model is not None else ()
        visuals = [(link.pose @ visual.pose, visual) for link in links for visual in link.visuals]
        for number, (place, visual) in enumerate(visuals):
            marker = _shape(visual.geometry)
            if marker is None:
                continue
            color = visual.material.color if visual.material is not None and visual.material.color else _GREY
            marker.header.frame_id = "world"
            marker.ns, marker.id = name, number
            marker.color = ColorRGBA(r=color[0], g=color[1], b=color[2], a=color[3])
            at = pose @ place
            position, orientation = marker.pose.position, marker.pose.orientation
            position.x, position.y, position.z = at.position
            orientation.x, orientation.y, orientation.z, orientation.w = at.orientation
            yield marker


def _pose(pose: Any) -> Pose:
    position, turn = pose.position, pose.orientation
    return Pose((position.x, position.y, position.z), (turn.x, turn.y, turn.z, turn.w))


def _shape(geometry: Geometry) -> Marker | None:
    """Return a marker of a shape; None for those that need a mesh, and for planes."""
    marker = Marker(action=Marker.ADD)
    if isinstance(geometry, Box):
        marker.type, size = Marker.CUBE, geometry.size
    elif isinstance(geometry, Cylinder):
        marker.type, size = Marker.CYLINDER, (2.0 * geometry.radius, 2.0 * geometry.radius, geometry.length)
    elif isinstance(geometry, Sphere):
        marker.type, size = Marker.SPHERE, (2.0 * geometry.radius,) * 3
    else:
        return None
    marker.scale.x, marker.scale.y, marker.scale.z = size
    return marker


def main() -> int:
    """Run the node."""
    return run(CellView)
