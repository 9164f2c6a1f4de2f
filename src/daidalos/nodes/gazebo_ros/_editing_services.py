"""Services to edit a running world: shapes, sizes and appearance of models."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.description.primitives import primitive
from daidalos.nodes.gazebo_ros._entities import find_entity
from daidalos.nodes.gazebo_ros._host import Host
from daidalos.nodes.gazebo_ros._shapes import model_parts, shape_markers
from daidalos.nodes.gazebo_ros._states import color_of, pose_message, pose_of, vector_of
from daidalos.simulation import Simulation
from daidalos.simulation.errors import SimulationError


class EditingServices:
    """Offers `daidalos_msgs` under the node's namespace.

    Parameters
    ----------
    node : Node
    host : Host
    group : CallbackGroup
    """

    def __init__(self, node: Any, host: Host, group: Any) -> None:
        from daidalos_msgs.srv import BringBack, GetShapes, InsertShape, ScaleEntity, SetFriction

        self._host = host
        node.create_service(InsertShape, "~/insert_shape", _reporting(self._insert), callback_group=group)
        node.create_service(GetShapes, "~/get_shapes", _reporting(self._shapes), callback_group=group)
        node.create_service(BringBack, "~/bring_back", _reporting(self._bring_back), callback_group=group)
        node.create_service(ScaleEntity, "~/scale_entity", _reporting(self._scale), callback_group=group)
        node.create_service(SetFriction, "~/set_friction", _reporting(self._set_friction), callback_group=group)

    def _insert(self, request: Any, response: Any) -> None:
        color = color_of(request.color) if request.color.a > 0 else (0.6, 0.6, 0.6, 1.0)
        model = primitive(request.shape, vector_of(request.size), request.mass, color)
        response.name = self._host.insert(model, request.name or None, pose_of(request.pose), rename=True)

    def _bring_back(self, request: Any, response: Any) -> None:
        self._host.bring_back(request.name)

    def _scale(self, request: Any, response: Any) -> None:
        self._host.scale(request.name, vector_of(request.factors))

    def _set_friction(self, request: Any, response: Any) -> None:
        def work(simulation: Simulation) -> None:
            entity = find_entity(simulation, request.name)
            simulation.set_friction(entity.model, request.friction, entity.link)

        self._host.paced.call(work)

    def _shapes(self, request: Any, response: Any) -> None:
        def work(simulation: Simulation) -> None:
            for name in request.names or simulation.models:
                model = simulation.instance(name).model
                response.shapes += shape_markers(model, name)
                response.models.append(model_parts(model, name))
                links = [(f"{name}::{link}", link) for link in model.links]
                for entity, link in [(name, None), *links]:
                    response.entities.append(entity)
                    response.poses.append(pose_message(simulation.pose(name, link)))

        self._host.paced.call(work)


def _reporting(work: Callable[[Any, Any], None]) -> Callable[[Any, Any], Any]:
    def answer(request: Any, response: Any) -> Any:
        try:
            work(request, response)
            response.success = True
        except (SimulationError, ValueError, LookupError) as error:
            response.success, response.status_message = False, str(error)
        return response

    return answer
