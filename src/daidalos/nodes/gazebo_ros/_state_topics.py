"""The topics that tell where models and links are, and what watched models touched."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from rclpy.publisher import Publisher

from daidalos.common.rate_gate import RateGate
from daidalos.nodes.gazebo_ros._descriptions import state_namespaces
from daidalos.nodes.gazebo_ros._states import contacts_message, pose_message, twist_message
from daidalos.nodes.qos import LATCHED

if TYPE_CHECKING:
    from daidalos.description.world import World
    from daidalos.simulation import Simulation

_STATES_RATE = 50.0


class StateTopics:
    """Publisher of ``model_states``, ``link_states`` and ``/gazebo/contacts``.

    Parameters
    ----------
    node : Node
        By which they are published.
    world : World
        Says in which namespaces.
    watched : str
        The model whose contacts with others than the ground are published; empty for none.
    """

    def __init__(self, node: Node, world: World, watched: str) -> None:
        from gazebo_msgs.msg import ContactsState, LinkStates, ModelStates

        places = state_namespaces(world)
        self._watched = watched
        self._gate = RateGate(_STATES_RATE)
        self._contacts: dict[str, Any] = {}
        self._published_touches = 0
        self._still: dict[tuple[str, str | None], tuple[Any, Any]] = {}
        self._still_in: Any = None
        self._states = [node.create_publisher(ModelStates, f"{place}/model_states", 10) for place in places]
        self._link_states = [node.create_publisher(LinkStates, f"{place}/link_states", 10) for place in places]
        self._contacts_publisher = node.create_publisher(ContactsState, "/gazebo/contacts", LATCHED)

    def follow(self, simulation: Simulation) -> None:
        """Watch the model to be watched if it came, and no longer if it went."""
        for name in [name for name in self._contacts if name not in simulation.models]:
            del self._contacts[name]
        if self._watched in simulation.models and self._watched not in self._contacts:
            self._contacts[self._watched] = simulation.monitor_contacts(self._watched, ["ground_plane"])

    def publish(self, simulation: Simulation, now_ns: int) -> None:
        """Publish the states when they are due, and the contacts when there are more."""
        if self._gate.is_due(now_ns):
            self._publish_states(simulation)
        self._publish_contacts(simulation)

    def _publish_states(self, simulation: Simulation) -> None:
        """Publish where models and links are, on topics that have subscribers."""
        from gazebo_msgs.msg import LinkStates, ModelStates

        models: list[tuple[str, str | None]] = [(name, None) for name in simulation.models]
        self._publish_motions(simulation, self._states, ModelStates, models)
        if any(_has_subscribers(publisher) for publisher in self._link_states):
            links: list[tuple[str, str | None]] = [
                (name, link) for name in simulation.models for link in simulation.instance(name).model.links
            ]
            self._publish_motions(simulation, self._link_states, LinkStates, links)

    def _publish_motions(
        self, simulation: Simulation, publishers: list[Any], kind: Any, entities: list[tuple[str, str | None]]
    ) -> None:
        listening = [publisher for publisher in publishers if _has_subscribers(publisher)]
        if not listening:
            return
        motions = [self._motion(simulation, *entity) for entity in entities]
        message = kind(
            name=["::".join(filter(None, entity)) for entity in entities],
            pose=[pose for pose, _ in motions],
            twist=[twist for _, twist in motions],
        )
        for publisher in listening:
            publisher.publish(message)

    def _motion(self, simulation: Simulation, model: str, link: str | None) -> tuple[Any, Any]:
        """Return the pose and the twist of a model or link; those of what cannot move are made once."""
        if self._still_in is not simulation.physics:  # another one follows whenever such a model is moved
            self._still_in = simulation.physics
            self._still.clear()
        motion = self._still.get((model, link))
        if motion is None:
            motion = pose_message(simulation.pose(model, link)), twist_message(*simulation.velocity(model, link))
            instance = simulation.instance(model)
            if instance.build.base is not None and not instance.build.trees and not instance.components:
                self._still[model, link] = motion
        return motion

    def _publish_contacts(self, simulation: Simulation) -> None:
        """Publish what the watched models have touched whenever that changes."""
        touches = [(name, touch) for name, monitor in self._contacts.items() for touch in monitor.touches]
        if len(touches) != self._published_touches:
            self._published_touches = len(touches)
            self._contacts_publisher.publish(contacts_message(touches, simulation.time_ns))


def _has_subscribers(publisher: Publisher) -> bool:
    return publisher.handle.has_subscribers
